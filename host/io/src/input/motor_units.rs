//! Units of somebody else's log, and their conversion to seconds, volts and encoder counts; those of measured columns stand in the table
//! of channels.

use crate::channel::{LinearUnit, Measured, PerMeasured};
use std::f64::consts::TAU;

/// Unit of the time column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeUnit {
    /// Seconds.
    #[default]
    Seconds,
    /// Milliseconds.
    Milliseconds,
    /// Microseconds.
    Microseconds,
    /// Nanoseconds.
    Nanoseconds,
}

/// Unit of the command column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CommandUnit {
    /// Volts: on the armature, or at the input of a current amplifier.
    #[default]
    Volts,
    /// Millivolts.
    Millivolts,
    /// Share of the supply voltage, −1 … 1.
    Duty,
    /// The same in percent, −100 … 100.
    Percent,
    /// The same of a timer with eight bits, −255 … 255.
    Pwm8,
    /// The same of a timer with ten bits, −1023 … 1023.
    Pwm10,
    /// The same of a Dynamixel, −885 … 885.
    Pwm885,
    /// The same in a signed byte, −127 … 127.
    SignedByte,
    /// Amperes, for a drive that closes a current loop.
    Amperes,
    /// Milliamperes, likewise.
    Milliamperes,
    /// Newton metres, for a drive that is told a torque.
    NewtonMetres,
}

/// Unit of the angle column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AngleUnit {
    /// The encoder's own counts.
    #[default]
    Counts,
    /// Degrees.
    Degrees,
    /// Radians.
    Radians,
    /// Revolutions.
    Revolutions,
    /// Metres of a linear axis.
    Metres,
    /// A speed in place of an angle, which is integrated.
    Speed(SpeedUnit),
}

/// Unit of a column that holds speeds where an angle is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpeedUnit {
    /// Radians a second.
    RadiansPerSecond,
    /// Degrees a second.
    DegreesPerSecond,
    /// Revolutions a second.
    RevolutionsPerSecond,
    /// Revolutions a minute.
    RevolutionsPerMinute,
    /// Counts a second.
    CountsPerSecond,
    /// Counts since the row before: exact, where the encoder is read once a row.
    CountsPerSample,
}

/// The units of one recording; the contract's own by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Units {
    /// Of the time column.
    pub time: TimeUnit,
    /// Of the command column.
    pub voltage: CommandUnit,
    /// Of the command column where it holds target angles; the angle's own if not said.
    pub target: Option<AngleUnit>,
    /// Of the angle column.
    pub angle: AngleUnit,
    /// Of the measured columns, by their places in the table of channels.
    pub measured: PerMeasured<usize>,
    /// Columns that are positive in the other direction than the rest.
    pub reversed: Reversed,
}

/// Columns whose sign is turned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reversed {
    /// The command.
    pub voltage: bool,
    /// The angle.
    pub angle: bool,
    /// The measured columns.
    pub measured: PerMeasured<bool>,
}

impl TimeUnit {
    /// Every unit with its name in `motor.toml`.
    pub const ALL: &'static [(&'static str, TimeUnit)] = &[
        ("s", TimeUnit::Seconds),
        ("ms", TimeUnit::Milliseconds),
        ("us", TimeUnit::Microseconds),
        ("ns", TimeUnit::Nanoseconds),
    ];

    /// The unit that a log calls so, in whatever case.
    pub fn of_text(text: &str) -> Option<Self> {
        let text = text.trim().to_lowercase();
        let mut all = TimeUnit::ALL.iter();
        all.find(|(name, _)| *name == text).map(|(_, unit)| *unit)
    }

    /// Seconds. Divides by a whole number, so that 1 ms becomes the double nearest to 0.001.
    pub fn seconds(self, time: f64) -> f64 {
        match self {
            TimeUnit::Seconds => time,
            TimeUnit::Milliseconds => time / 1e3,
            TimeUnit::Microseconds => time / 1e6,
            TimeUnit::Nanoseconds => time / 1e9,
        }
    }

    /// Header names looked for where [columns] names none, best first.
    pub(super) fn default_names(self) -> &'static [&'static str] {
        match self {
            TimeUnit::Seconds => &["t_s"],
            TimeUnit::Milliseconds => &["t_ms", "t_s"],
            TimeUnit::Microseconds => &["t_us", "t_s"],
            TimeUnit::Nanoseconds => &["t_ns", "t_s"],
        }
    }
}

impl Units {
    /// Unit of a measured column.
    pub fn of(&self, channel: Measured) -> &'static LinearUnit {
        let all = channel.facts().units;
        all.get(self.measured[channel]).unwrap_or(&all[0])
    }

    /// Unit of target angles.
    pub fn of_target(&self) -> AngleUnit {
        self.target.unwrap_or(self.angle)
    }
}

impl CommandUnit {
    /// Every unit with its name in `motor.toml`.
    pub const ALL: &'static [(&'static str, CommandUnit)] = &[
        ("V", CommandUnit::Volts),
        ("mV", CommandUnit::Millivolts),
        ("duty", CommandUnit::Duty),
        ("percent", CommandUnit::Percent),
        ("pwm8", CommandUnit::Pwm8),
        ("pwm10", CommandUnit::Pwm10),
        ("pwm885", CommandUnit::Pwm885),
        ("int8", CommandUnit::SignedByte),
        ("A", CommandUnit::Amperes),
        ("mA", CommandUnit::Milliamperes),
        ("N*m", CommandUnit::NewtonMetres),
    ];

    /// What all of the supply is in this unit; `None` where it is no share of it.
    pub fn full_scale(self) -> Option<f64> {
        match self {
            CommandUnit::Duty => Some(1.0),
            CommandUnit::Percent => Some(100.0),
            CommandUnit::Pwm8 => Some(255.0),
            CommandUnit::Pwm10 => Some(1023.0),
            CommandUnit::Pwm885 => Some(885.0),
            CommandUnit::SignedByte => Some(127.0),
            _ => None,
        }
    }

    /// The unit with this name in `motor.toml`.
    pub fn by_name(name: &str) -> Option<Self> {
        let mut all = CommandUnit::ALL.iter();
        all.find(|(own, _)| *own == name).map(|(_, unit)| *unit)
    }

    /// Whether it is what a drive with a current loop is told, and no voltage.
    pub fn is_of_current(self) -> bool {
        matches!(
            self,
            CommandUnit::Amperes | CommandUnit::Milliamperes | CommandUnit::NewtonMetres
        )
    }

    /// Its name in `motor.toml`.
    pub fn name(self) -> &'static str {
        let named = CommandUnit::ALL.iter().find(|(_, unit)| *unit == self);
        named.map_or("V", |(name, _)| name)
    }

    /// Header names looked for where [columns] names none, best first.
    pub(super) fn default_names(self) -> &'static [&'static str] {
        match self {
            CommandUnit::Duty => &["duty", "voltage_v"],
            CommandUnit::NewtonMetres => &["torque_n_m", "voltage_v"],
            _ if self.full_scale().is_some() => &["pwm", "duty", "voltage_v"],
            _ => &["voltage_v"],
        }
    }
}

impl AngleUnit {
    /// Every unit with its name in `motor.toml`.
    pub const ALL: &'static [(&'static str, AngleUnit)] = &[
        ("counts", AngleUnit::Counts),
        ("deg", AngleUnit::Degrees),
        ("rad", AngleUnit::Radians),
        ("rev", AngleUnit::Revolutions),
        ("m", AngleUnit::Metres),
    ];

    /// Every unit of a speed that may stand in an angle's place, with its name in `motor.toml`.
    pub const SPEEDS: &'static [(&'static str, AngleUnit)] = &[
        ("rad/s", AngleUnit::Speed(SpeedUnit::RadiansPerSecond)),
        ("deg/s", AngleUnit::Speed(SpeedUnit::DegreesPerSecond)),
        ("rev/s", AngleUnit::Speed(SpeedUnit::RevolutionsPerSecond)),
        ("rpm", AngleUnit::Speed(SpeedUnit::RevolutionsPerMinute)),
        ("counts/s", AngleUnit::Speed(SpeedUnit::CountsPerSecond)),
        (
            "counts/sample",
            AngleUnit::Speed(SpeedUnit::CountsPerSample),
        ),
    ];

    /// The unit with this name in `motor.toml`, of an angle or of a speed in its place.
    pub fn by_name(name: &str) -> Option<Self> {
        let mut all = AngleUnit::ALL.iter().chain(AngleUnit::SPEEDS);
        all.find(|(own, _)| *own == name).map(|(_, unit)| *unit)
    }

    /// The unit that a log calls so, in whatever case.
    pub fn of_text(text: &str) -> Option<Self> {
        // `rotations (1 rotation = 6.28 radians)` are rotations.
        let text = text.split('(').next().unwrap_or(text);
        let text = text.trim().to_lowercase();
        let long: &[(&str, AngleUnit)] = &[
            ("radian", AngleUnit::Radians),
            ("radians", AngleUnit::Radians),
            ("degree", AngleUnit::Degrees),
            ("degrees", AngleUnit::Degrees),
            ("\u{b0}", AngleUnit::Degrees),
            ("rotation", AngleUnit::Revolutions),
            ("rotations", AngleUnit::Revolutions),
            ("revolutions", AngleUnit::Revolutions),
            ("turns", AngleUnit::Revolutions),
            ("ticks", AngleUnit::Counts),
            ("meters", AngleUnit::Metres),
            ("metres", AngleUnit::Metres),
        ];
        let mut all = long.iter().chain(AngleUnit::ALL).chain(AngleUnit::SPEEDS);
        all.find(|(name, _)| *name == text).map(|(_, unit)| *unit)
    }

    /// Length of one revolution in this unit; for metres the user's `metres_per_rev`, for counts the encoder's
    /// own number. For a speed what it is at one revolution a second, or a sample.
    pub fn per_revolution(self, counts_per_rev: f64, metres_per_rev: f64) -> f64 {
        match self {
            AngleUnit::Counts => counts_per_rev,
            AngleUnit::Degrees => 360.0,
            AngleUnit::Radians => TAU,
            AngleUnit::Revolutions => 1.0,
            AngleUnit::Metres => metres_per_rev,
            AngleUnit::Speed(speed) => match speed {
                SpeedUnit::RadiansPerSecond => TAU,
                SpeedUnit::DegreesPerSecond => 360.0,
                SpeedUnit::RevolutionsPerSecond => 1.0,
                SpeedUnit::RevolutionsPerMinute => 60.0,
                SpeedUnit::CountsPerSecond | SpeedUnit::CountsPerSample => counts_per_rev,
            },
        }
    }

    /// Header names looked for where [columns] names none, best first.
    pub(super) fn default_names(self) -> &'static [&'static str] {
        match self {
            AngleUnit::Counts => &["angle_counts"],
            AngleUnit::Degrees => &["angle_deg", "angle_counts"],
            AngleUnit::Radians => &["angle_rad", "angle_counts"],
            AngleUnit::Revolutions => &["angle_rev", "angle_counts"],
            AngleUnit::Metres => &["position_m", "angle_counts"],
            AngleUnit::Speed(speed) => match speed {
                SpeedUnit::RadiansPerSecond => &["speed_rad_s"],
                SpeedUnit::DegreesPerSecond => &["speed_deg_s"],
                SpeedUnit::RevolutionsPerSecond => &["speed_rev_s"],
                SpeedUnit::RevolutionsPerMinute => &["speed_rpm", "rpm"],
                SpeedUnit::CountsPerSecond => &["speed_counts_s"],
                SpeedUnit::CountsPerSample => &["counts_per_sample"],
            },
        }
    }

    /// The same for target angles.
    pub(super) fn target_names(self) -> &'static [&'static str] {
        match self {
            AngleUnit::Counts => &["target_counts"],
            AngleUnit::Degrees => &["target_deg"],
            AngleUnit::Radians => &["target_rad"],
            AngleUnit::Revolutions => &["target_rev"],
            AngleUnit::Metres => &["target_m"],
            // Refused where it is read.
            AngleUnit::Speed(_) => &[],
        }
    }
}
