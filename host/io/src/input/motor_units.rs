//! Units of somebody else's log, and their conversion to seconds, volts, amperes and encoder counts.

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
}

/// Unit of the command column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CommandUnit {
    /// Volts: on the armature, or at the input of a current amplifier.
    #[default]
    Volts,
    /// Share of the supply voltage, −1 … 1.
    Duty,
    /// Amperes, for a drive that closes a current loop.
    Amperes,
    /// Milliamperes, likewise.
    Milliamperes,
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
}

/// Unit of the current column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CurrentUnit {
    /// Amperes.
    #[default]
    Amperes,
    /// Milliamperes.
    Milliamperes,
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
    /// Of the current column.
    pub current: CurrentUnit,
}

impl TimeUnit {
    /// Every unit with its name in `motor.toml`.
    pub const ALL: &'static [(&'static str, TimeUnit)] = &[
        ("s", TimeUnit::Seconds),
        ("ms", TimeUnit::Milliseconds),
        ("us", TimeUnit::Microseconds),
    ];

    /// Seconds. Divides by a whole number, so that 1 ms becomes the double nearest to 0.001.
    pub fn seconds(self, time: f64) -> f64 {
        match self {
            TimeUnit::Seconds => time,
            TimeUnit::Milliseconds => time / 1e3,
            TimeUnit::Microseconds => time / 1e6,
        }
    }

    /// Header names looked for where [columns] names none, best first.
    pub(super) fn default_names(self) -> &'static [&'static str] {
        match self {
            TimeUnit::Seconds => &["t_s"],
            TimeUnit::Milliseconds => &["t_ms", "t_s"],
            TimeUnit::Microseconds => &["t_us", "t_s"],
        }
    }
}

impl Units {
    /// Unit of target angles.
    pub fn of_target(&self) -> AngleUnit {
        self.target.unwrap_or(self.angle)
    }
}

impl CommandUnit {
    /// Every unit with its name in `motor.toml`.
    pub const ALL: &'static [(&'static str, CommandUnit)] = &[
        ("V", CommandUnit::Volts),
        ("duty", CommandUnit::Duty),
        ("A", CommandUnit::Amperes),
        ("mA", CommandUnit::Milliamperes),
    ];

    /// Header names looked for where [columns] names none, best first.
    pub(super) fn default_names(self) -> &'static [&'static str] {
        match self {
            CommandUnit::Duty => &["duty", "voltage_v"],
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

    /// Length of one revolution in this unit; for metres the user's `metres_per_rev`, for counts the encoder's
    /// own number.
    pub fn per_revolution(self, counts_per_rev: f64, metres_per_rev: f64) -> f64 {
        match self {
            AngleUnit::Counts => counts_per_rev,
            AngleUnit::Degrees => 360.0,
            AngleUnit::Radians => TAU,
            AngleUnit::Revolutions => 1.0,
            AngleUnit::Metres => metres_per_rev,
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
        }
    }
}

impl CurrentUnit {
    /// Every unit with its name in `motor.toml`.
    pub const ALL: &'static [(&'static str, CurrentUnit)] = &[
        ("A", CurrentUnit::Amperes),
        ("mA", CurrentUnit::Milliamperes),
    ];

    /// Amperes.
    pub fn amperes(self, current: f64) -> f64 {
        match self {
            CurrentUnit::Amperes => current,
            CurrentUnit::Milliamperes => current / 1e3,
        }
    }

    /// Header names looked for where [columns] names none, best first.
    pub(super) fn default_names(self) -> &'static [&'static str] {
        match self {
            CurrentUnit::Amperes => &["current_a"],
            CurrentUnit::Milliamperes => &["current_ma", "current_a"],
        }
    }
}
