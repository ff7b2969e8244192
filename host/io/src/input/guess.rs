//! Which column of a foreign log may be what, and in which unit, told by the names of its header. The advice of the
//! reader and the fields of the workbench come from here; nothing is ever read by a guess alone.

use super::motor_drive::DriveKind;
use super::suggest::nearest;

/// A column that may be the one wanted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guess {
    /// Its name in the header.
    pub column: String,
    /// The unit that its name tells, as `[units]` calls it, where that is not the usual one.
    pub unit: Option<&'static str>,
}

/// A quantity, as logs call it.
struct Quantity {
    /// Its key in `[columns]`.
    key: &'static str,
    /// What it is called, the likeliest first.
    words: &'static [&'static str],
    /// What stands in the name of another quantity that shares a word with this one.
    others: &'static [&'static str],
    /// The last part of a name, and the unit that it tells. Usual units (s, V, counts, A) need no telling.
    units: &'static [(&'static str, &'static str)],
}

/// What is wanted of a controller, and not what was measured.
const WANTED: &[&str] = &[
    "target",
    "goal",
    "ref",
    "reference",
    "set",
    "setpoint",
    "desired",
    "des",
    "cmd",
    "command",
    "error",
];
const ANGLE_UNITS: &[(&str, &str)] = &[
    ("rad", "rad"),
    ("radians", "rad"),
    ("deg", "deg"),
    ("degrees", "deg"),
    ("rev", "rev"),
    ("revs", "rev"),
    ("rot", "rev"),
    ("rotations", "rev"),
    ("turns", "rev"),
    ("m", "m"),
];

/// In the order in which they take a name that several could have.
const QUANTITIES: &[Quantity] = &[
    Quantity {
        key: "time",
        words: &[
            "t_s",
            "time",
            "timestamp",
            "t",
            "seconds",
            "sec",
            "millis",
            "micros",
            "clock",
        ],
        others: &[],
        units: &[
            ("ms", "ms"),
            ("millis", "ms"),
            ("milliseconds", "ms"),
            ("us", "us"),
            ("µs", "us"),
            ("micros", "us"),
            ("microseconds", "us"),
        ],
    },
    Quantity {
        key: "target",
        words: &[
            "target",
            "goal",
            "setpoint",
            "reference",
            "desired",
            "ref",
            "command",
            "action",
        ],
        others: &["speed", "velocity", "torque", "error"],
        units: ANGLE_UNITS,
    },
    Quantity {
        key: "voltage",
        words: &[
            "voltage_v",
            "voltage",
            "volts",
            "volt",
            "duty",
            "pwm",
            "command",
            "cmd",
            "u",
            "v",
            "plant_input",
            "control_output",
            "control",
            "input",
        ],
        others: &[
            "supply", "bus", "vbus", "battery", "bat", "vin", "limit", "max", "sag",
        ],
        units: &[("duty", "duty"), ("pwm", "duty")],
    },
    Quantity {
        key: "angle",
        words: &[
            "angle_counts",
            "angle",
            "position",
            "counts",
            "count",
            "encoder",
            "ticks",
            "theta",
            "enc",
            "pos",
            "q",
            "turns",
        ],
        others: WANTED,
        units: ANGLE_UNITS,
    },
    Quantity {
        key: "current",
        words: &["current_a", "current", "amps", "amp", "i_a", "i"],
        others: &[
            "target",
            "goal",
            "ref",
            "reference",
            "setpoint",
            "desired",
            "limit",
            "max",
            "bus",
        ],
        units: &[("ma", "mA"), ("milliamps", "mA")],
    },
    Quantity {
        key: "temperature",
        words: &[
            "temperature_c",
            "temperature",
            "temp_motor",
            "motor_temp",
            "winding_temp",
            "temp",
        ],
        others: &[
            "mos", "mosfet", "fet", "board", "pcb", "cpu", "mcu", "ambient", "driver", "esc",
            "inverter", "limit", "max", "fault",
        ],
        units: &[("k", "K"), ("kelvin", "K"), ("f", "F")],
    },
    Quantity {
        key: "enabled",
        words: &["enabled", "enable", "torque_enabled", "armed"],
        others: &[],
        units: &[],
    },
];

/// What a drive that closes a current loop is commanded by.
const COMMANDED_CURRENT: Quantity = Quantity {
    key: "voltage",
    words: &[
        "current_command",
        "command",
        "cmd",
        "current_a",
        "current",
        "torque",
        "i",
        "voltage",
        "u",
    ],
    others: &["limit", "max", "bus"],
    units: &[("a", "A"), ("amps", "A"), ("ma", "mA")],
};

/// How surely a name means a quantity, the surest first.
#[derive(Clone, Copy)]
enum Match {
    /// The name is nearly the one that the user gave.
    Called,
    /// The name is the word.
    Whole,
    /// The name begins with the word, or a long word stands somewhere in it.
    Part,
    /// The name is nearly the word, or a symbol with an index.
    Nearly,
}

/// What a column is sought for.
#[derive(Clone, Copy, Debug)]
pub struct Sought<'n> {
    /// Its key in `[columns]`.
    pub key: &'n str,
    /// The name under which it was sought and not found, if a user gave one.
    pub called: Option<&'n str>,
}

/// Guesses among the names of a `header` that are not `taken`, in the order of what is `sought`. A name is guessed once: what means
/// one quantity for sure is not given to another.
pub fn guess(
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
    for how in [Match::Called, Match::Whole, Match::Part, Match::Nearly] {
        for (sought, found) in sought.iter().zip(&mut found) {
            let Some(quantity) = quantity(sought.key, kind).filter(|_| found.is_none()) else {
                continue;
            };
            let name = match how {
                Match::Called => sought
                    .called
                    .and_then(|name| nearest(name, free.iter().copied())),
                how => quantity.among(&free, how),
            };
            if let Some(name) = name {
                free.retain(|other| *other != name);
                *found = Some(Guess {
                    column: name.to_owned(),
                    unit: quantity.unit_of(name),
                });
            }
        }
    }
    found
}

/// Units of a speed that names end with, longest first.
const SPEED_UNITS: &[(&str, &str)] = &[
    ("counts_per_sample", "counts/sample"),
    ("counts_s", "counts/s"),
    ("rad_s", "rad/s"),
    ("rads", "rad/s"),
    ("deg_s", "deg/s"),
    ("dps", "deg/s"),
    ("rev_s", "rev/s"),
    ("rps", "rev/s"),
    ("rpm", "rpm"),
];
/// What speeds are called, the likeliest first.
const SPEED_WORDS: &[&str] = &[
    "speed", "velocity", "omega", "velo", "vel", "rpm", "dtheta", "dq", "qd", "w",
];

/// The column that may hold a speed, where a log has no angle; its unit is radians a second if the name tells none.
pub fn speed(header: &[String], taken: &[&str]) -> Option<Guess> {
    let free = || header.iter().filter(|name| !taken.contains(&name.as_str()));
    let own = |name: &&String| !parts(name).any(|part| WANTED.contains(&part.as_str()));
    let called = SPEED_WORDS
        .iter()
        .find_map(|word| free().filter(own).find(|name| is_called(name, word)))?;
    let plain: Vec<String> = parts(called).collect();
    let plain = plain.join("_");
    let told = SPEED_UNITS.iter().find(|(end, _)| plain.ends_with(end));
    Some(Guess {
        column: called.clone(),
        unit: Some(told.map_or("rad/s", |(_, unit)| unit)),
    })
}

fn quantity(key: &str, kind: DriveKind) -> Option<&'static Quantity> {
    match (key, kind) {
        ("voltage", DriveKind::Current) => Some(&COMMANDED_CURRENT),
        _ => QUANTITIES.iter().find(|quantity| quantity.key == key),
    }
}

impl Quantity {
    fn among<'n>(&self, free: &[&'n str], how: Match) -> Option<&'n str> {
        let own: Vec<&str> = (free.iter().copied())
            .filter(|name| !self.is_another(name))
            .collect();
        let words = self.words;
        let called = |is: fn(&str, &str) -> bool| {
            (words.iter()).find_map(|word| own.iter().copied().find(|name| is(name, word)))
        };
        match how {
            Match::Called => None,
            Match::Whole => called(|name, word| name.eq_ignore_ascii_case(word)),
            Match::Part => called(is_called),
            Match::Nearly => own.iter().copied().find(|name| self.is_nearly(name)),
        }
    }

    /// Whether a name is misspelt, or a symbol with an index (`qm`, `vm`).
    fn is_nearly(&self, name: &str) -> bool {
        let name = name.to_lowercase();
        match name.len() {
            0 | 1 => false,
            2 => (self.words.iter()).any(|word| word.len() == 1 && name.starts_with(word)),
            _ => {
                let long = self.words.iter().copied().filter(|word| word.len() > 2);
                nearest(&name, long).is_some()
            }
        }
    }

    fn is_another(&self, name: &str) -> bool {
        parts(name).any(|part| self.others.contains(&part.as_str()))
    }

    fn unit_of(&self, name: &str) -> Option<&'static str> {
        let last = parts(name).last()?;
        let told = self.units.iter().find(|(word, _)| *word == last);
        told.map(|(_, unit)| *unit)
    }
}

/// A name in lower case, cut at what is no letter or digit.
fn parts(name: &str) -> impl Iterator<Item = String> + '_ {
    name.split(|c: char| !c.is_alphanumeric())
        .filter(|part| !part.is_empty())
        .map(str::to_lowercase)
}

/// A short word must be the first part of the name, a long one may stand anywhere in it.
fn is_called(name: &str, word: &str) -> bool {
    if word.len() > 3 {
        return name.to_lowercase().contains(word);
    }
    parts(name).next().is_some_and(|first| first == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn any(key: &str) -> Sought<'_> {
        Sought { key, called: None }
    }

    fn all() -> [Sought<'static>; 5] {
        ["time", "voltage", "angle", "current", "enabled"].map(any)
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
            key: "angle",
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
            &["target", "angle"].map(any),
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
