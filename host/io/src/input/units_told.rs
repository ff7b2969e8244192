//! Units that a log itself tells: in a row of its own, beside a column, or in a column's name.

use super::layout::{Column, Layout};
use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, CommandUnit, SpeedUnit, TimeUnit};
use super::names::folded;
use super::preset::Preset;
use crate::channel::{Channel, Measured};

/// What speeds are written in, besides the names in [`AngleUnit::SPEEDS`].
const SPEEDS: &[(&str, SpeedUnit)] = &[
    ("1/min", SpeedUnit::RevolutionsPerMinute),
    ("min-1", SpeedUnit::RevolutionsPerMinute),
    ("u/min", SpeedUnit::RevolutionsPerMinute),
    ("tr/min", SpeedUnit::RevolutionsPerMinute),
    ("r/min", SpeedUnit::RevolutionsPerMinute),
    ("rev/min", SpeedUnit::RevolutionsPerMinute),
    ("rps", SpeedUnit::RevolutionsPerSecond),
    ("r/s", SpeedUnit::RevolutionsPerSecond),
    ("dps", SpeedUnit::DegreesPerSecond),
    ("ticks/s", SpeedUnit::CountsPerSecond),
    ("cps", SpeedUnit::CountsPerSecond),
];

/// The name under `[units]` of what a log writes as the unit of a channel's column; none where it is no unit of it.
pub(super) fn unit_of(channel: Channel, text: &str) -> Option<&'static str> {
    let text = text.trim().trim_start_matches(['[', '(', '{', '<']);
    let text = text.trim_end_matches([']', ')', '}', '>']).trim();
    if text.is_empty() {
        return None;
    }
    let low = folded(text).replace('\u{b7}', "*");
    let facts = channel.facts();
    let told = || {
        let mut all = facts.told_units.iter();
        all.find(|(word, _)| *word == low).map(|(_, unit)| *unit)
    };
    let named = |names: &mut dyn Iterator<Item = &'static str>| {
        // V is a volt, and mV a millivolt; but v, s and deg are written in any case.
        let exact = |name: &&'static str| *name == text;
        let any: Vec<&'static str> = names.collect();
        let loose = any.iter().find(|name| name.to_lowercase() == low);
        any.iter().find(|name| exact(name)).or(loose).copied()
    };
    match channel {
        Channel::Time => named(&mut TimeUnit::ALL.iter().map(|(name, _)| *name)).or_else(told),
        Channel::Command => {
            named(&mut CommandUnit::ALL.iter().map(|(name, _)| *name)).or_else(told)
        }
        Channel::Angle => {
            let mut all = AngleUnit::ALL.iter().chain(AngleUnit::SPEEDS);
            let unit = AngleUnit::of_text(text).or_else(|| {
                let mut speeds = SPEEDS.iter();
                let speed = speeds.find(|(name, _)| *name == low);
                speed.map(|(_, unit)| AngleUnit::Speed(*unit))
            });
            let own = unit.and_then(|unit| all.find(|(_, other)| *other == unit));
            own.map(|(name, _)| *name).or_else(told)
        }
        Channel::Measured(_) => named(&mut facts.units.iter().map(|unit| unit.name)).or_else(told),
        Channel::Enabled | Channel::Direction => None,
    }
}

/// A motor file with the units that a log tells of its columns, where the user says no others than the usual ones.
pub(super) fn with_units<'u>(
    motor: &MotorFile,
    layout: &Layout,
    unit: &dyn Fn(usize) -> Option<&'u str>,
) -> MotorFile {
    let mut told = motor.clone();
    let usual = motor.log.preset.map(Preset::units).unwrap_or_default();
    let named = |channel: Channel, column: &Column| unit_of(channel, unit(column.index)?);
    let kind = motor.drive_kind();
    if let Some(name) = layout
        .time
        .as_ref()
        .and_then(|column| named(Channel::Time, column))
        && motor.units.time == usual.time
    {
        told.set_unit(Channel::Time, name);
    }
    if kind == DriveKind::Voltage
        && motor.units.voltage == usual.voltage
        && let Some(name) = named(Channel::Command, &layout.command)
        && CommandUnit::by_name(name).is_some_and(|unit| !unit.is_of_current())
    {
        told.set_unit(Channel::Command, name);
    }
    if let Some(name) = named(Channel::Angle, &layout.angle)
        && motor.units.angle == usual.angle
    {
        told.set_unit(Channel::Angle, name);
    }
    for (channel, column) in &layout.measured {
        if let Some(name) = named(Channel::Measured(*channel), column)
            && motor.units.measured[*channel] == usual.measured[*channel]
        {
            told.set_unit(Channel::Measured(*channel), name);
        }
    }
    told
}

impl MotorFile {
    /// Sets the unit of a channel by its name under `[units]`; one that is not known is passed over.
    pub(super) fn set_unit(&mut self, channel: Channel, name: &str) {
        let units = &mut self.units;
        match channel {
            Channel::Time => {
                if let Some((_, unit)) = TimeUnit::ALL.iter().find(|(own, _)| *own == name) {
                    units.time = *unit;
                }
            }
            Channel::Command if self.position.is_some() => units.target = AngleUnit::by_name(name),
            Channel::Command => {
                if let Some(unit) = CommandUnit::by_name(name) {
                    units.voltage = unit;
                }
            }
            Channel::Angle => {
                if let Some(unit) = AngleUnit::by_name(name) {
                    units.angle = unit;
                }
            }
            Channel::Measured(channel) => {
                if let Some(place) = place_of(channel, name) {
                    units.measured[channel] = place;
                }
            }
            Channel::Enabled | Channel::Direction => {}
        }
    }
}

fn place_of(channel: Measured, name: &str) -> Option<usize> {
    let mut units = channel.facts().units.iter();
    units.position(|unit| unit.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_told_as_people_write_them() {
        for (channel, text, wanted) in [
            (Channel::Time, "[s]", Some("s")),
            (Channel::Time, "(ms)", Some("ms")),
            (Channel::Time, "\u{b5}s", Some("us")),
            (Channel::Command, "[V]", Some("V")),
            (Channel::Command, "mV", Some("mV")),
            (Channel::Command, "%", Some("percent")),
            (Channel::Command, "A", Some("A")),
            (Channel::Angle, "[\u{b0}]", Some("deg")),
            (Channel::Angle, "Grad", Some("deg")),
            (Channel::Angle, "rad", Some("rad")),
            (Channel::Angle, "U/min", Some("rpm")),
            (Channel::Angle, "counts/s", Some("counts/s")),
            (Channel::Measured(Measured::Current), "[mA]", Some("mA")),
            (Channel::Angle, "apples", None),
            (Channel::Time, "[]", None),
        ] {
            assert_eq!(unit_of(channel, text), wanted, "{text}");
        }
    }
}
