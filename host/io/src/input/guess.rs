//! Which column of a foreign log may be what, and in which unit, told by the names of its header alone: the advice of the reader where a
//! column is missing. What `open` proposes and the other verbs take looks at the values as well: see [`proposal`](super::proposal).

use super::motor_drive::DriveKind;
use super::names::{Match, parts};
use super::suggest::nearest;
use super::units_told::unit_of;
use crate::channel::Channel;

/// A column that may be the one wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guess {
    /// Its name in the header.
    pub column: String,
    /// The unit that its name tells, as `[units]` calls it, where that is not the usual one.
    pub unit: Option<&'static str>,
}

/// What a column is sought for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sought<'n> {
    /// The channel.
    pub(super) channel: Channel,
    /// The name under which it was sought and not found, if a user gave one.
    pub(super) called: Option<&'n str>,
}

/// Guesses among the names of a `header` that are not `taken`, in the order of what is `sought`. A name is guessed once: what means
/// one quantity for sure is not given to another.
pub(super) fn guess(
    header: &[String],
    sought: &[Sought<'_>],
    kind: DriveKind,
    taken: &[String],
) -> Vec<Option<Guess>> {
    let mut free: Vec<&str> = header
        .iter()
        .map(String::as_str)
        .filter(|name| !name.is_empty() && !taken.iter().any(|taken| taken == name))
        .collect();
    let mut found: Vec<Option<Guess>> = vec![None; sought.len()];
    for how in [
        None,
        Some(Match::Whole),
        Some(Match::Part),
        Some(Match::Nearly),
    ] {
        for (sought, found) in sought.iter().zip(&mut found) {
            if found.is_some() {
                continue;
            }
            let name = match how {
                None => (sought.called).and_then(|name| nearest(name, free.iter().copied())),
                Some(how) => among(&free, sought.channel, kind, how),
            };
            if let Some(name) = name {
                free.retain(|other| *other != name);
                *found = Some(Guess {
                    column: name.to_owned(),
                    unit: told_unit(sought.channel, name),
                });
            }
        }
    }
    found
}

fn among<'n>(free: &[&'n str], channel: Channel, kind: DriveKind, how: Match) -> Option<&'n str> {
    let called = |name: &&'n str| {
        let found = match (channel, kind) {
            (Channel::Command, DriveKind::Position) => super::quantity::target(name),
            (Channel::Command, DriveKind::Current) => super::quantity::commanded_current(name),
            _ => channel.facts().called(name),
        };
        found.filter(|(own, _)| *own == how).map(|(_, place)| place)
    };
    let own = free.iter().filter_map(|name| Some((called(name)?, *name)));
    // Of equals the first.
    own.min_by_key(|(place, _)| *place).map(|(_, name)| name)
}

/// The unit that a name tells, where that is not the usual one.
pub(super) fn told_unit(channel: Channel, name: &str) -> Option<&'static str> {
    let usual = match channel {
        Channel::Time => "s",
        Channel::Command => "V",
        Channel::Angle => "counts",
        Channel::Measured(channel) => channel.facts().units[0].name,
        Channel::Enabled | Channel::Direction => return None,
    };
    super::quantity::unit_in(channel, name)
        .or_else(|| by_last_part(channel, name))
        .filter(|unit| *unit != usual)
}

fn by_last_part(channel: Channel, name: &str) -> Option<&'static str> {
    let parts = parts(name);
    let last = parts.last()?;
    let own = unit_of(channel, last).filter(|_| parts.len() > 1 || last.len() > 1);
    match channel {
        // `pwm` and `duty` are names of commands and tell their unit as well.
        Channel::Command if own.is_none() => {
            let is = |word: &str| parts.iter().any(|part| part == word);
            (is("duty") || is("pwm")).then_some("duty")
        }
        _ => own,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channel::Measured;

    fn any(channel: Channel) -> Sought<'static> {
        let called = None;
        Sought { channel, called }
    }

    fn all() -> [Sought<'static>; 5] {
        [
            Channel::Time,
            Channel::Command,
            Channel::Angle,
            Channel::Measured(Measured::Current),
            Channel::Enabled,
        ]
        .map(any)
    }

    fn names(line: &str) -> Vec<String> {
        line.split(['|', ','])
            .map(|name| name.trim().to_owned())
            .collect()
    }

    #[test]
    fn columns_are_guessed_from_names_that_people_use() {
        for (header, wanted) in [
            (
                "t_s,voltage_v,angle_counts",
                "t_s,voltage_v,angle_counts,,|,,",
            ),
            ("time,u,theta_rad", "time,u,theta_rad,,|,,rad"),
            (
                "Timestamp [ms],Duty,Position (deg)",
                "Timestamp [ms],Duty,Position (deg),,|ms,duty,deg",
            ),
            ("t,qm,vir", "t,,qm,,|,,"),
            (
                "t,target_theta,target_alpha,theta,alpha,control_output,feedforward,plant_input,saturation",
                "t,plant_input,theta,,|,,",
            ),
            (
                "t_s,voltage_V,angle_rad,pwm_counts,supply_V,torque_enabled,goal_rad",
                "t_s,voltage_V,angle_rad,,torque_enabled|,,rad",
            ),
            (
                "t_ms,bus_voltage,motor_voltage,pos_ref,pos,iq_current",
                "t_ms,motor_voltage,pos,iq_current,|ms,,",
            ),
            (
                "millis,pwm,ticks,enable",
                "millis,pwm,ticks,,enable|ms,duty,",
            ),
            ("supply_v,speed", ",,,,|,,"),
            (
                "tme_s,voltge_v,angle_count",
                "tme_s,voltge_v,angle_count,,|,,",
            ),
            (
                "Zeit [s],Spannung [mV],Winkel [Grad],Strom",
                "Zeit [s],Spannung [mV],Winkel [Grad],Strom,|,mV,deg",
            ),
            (
                "temps,tension,position (tr),courant",
                "temps,tension,position (tr),courant,|,,",
            ),
            (
                "tiempo (ms),voltaje,ángulo (grados)",
                "tiempo (ms),voltaje,ángulo (grados),,|ms,,deg",
            ),
            ("时间,电压,角度", "时间,电压,角度,,|,,"),
        ] {
            let found = guess(&names(header), &all(), DriveKind::Voltage, &[]);
            let column = |guess: &Option<Guess>| {
                guess
                    .as_ref()
                    .map_or_else(String::new, |guess| guess.column.clone())
            };
            let unit = |guess: &Option<Guess>| {
                guess
                    .as_ref()
                    .and_then(|guess| guess.unit)
                    .unwrap_or_default()
            };
            let columns: Vec<String> = found.iter().map(column).collect();
            let units: Vec<&str> = found[..3].iter().map(unit).collect();
            assert_eq!(
                format!("{}|{}", columns.join(","), units.join(",")),
                wanted,
                "{header}"
            );
        }
    }

    #[test]
    fn what_is_taken_is_not_guessed_and_nothing_twice() {
        let header = names("position,angle,u,v,t,time");
        let taken = ["angle".to_owned(), "t".to_owned()];
        let found = guess(&header, &all(), DriveKind::Voltage, &taken);
        let columns: Vec<&str> = found
            .iter()
            .flatten()
            .map(|guess| guess.column.as_str())
            .collect();
        assert_eq!(columns, ["time", "u", "position"]);
    }

    #[test]
    fn a_name_that_a_user_gave_comes_first() {
        let header = names("t_s,position,speed_mesured");
        let sought = Sought {
            channel: Channel::Angle,
            called: Some("speed_measured"),
        };
        let found = guess(&header, &[sought], DriveKind::Voltage, &[]);
        assert_eq!(
            found[0].as_ref().map(|guess| guess.column.as_str()),
            Some("speed_mesured")
        );
    }

    #[test]
    fn a_position_loop_is_commanded_by_its_target() {
        let header = names("t,goal_rad,angle_rad");
        let found = guess(
            &header,
            &[Channel::Command, Channel::Angle].map(any),
            DriveKind::Position,
            &[],
        );
        let columns: Vec<&str> = found
            .iter()
            .flatten()
            .map(|guess| guess.column.as_str())
            .collect();
        assert_eq!(columns, ["goal_rad", "angle_rad"]);
    }
}
