//! What well-known programs and controllers call their columns, and in which units they write them.
//!
//! A preset stands in the place of `[columns]`, `[units]` and the drive's kind; what a user says beside it holds. Each column
//! has the names that the maker's own tools write, the likeliest first.

use super::motor_drive::DriveKind;
use super::motor_units::{AngleUnit, CommandUnit, SpeedUnit, TimeUnit, Units};
use crate::channel::{Channel, Measured, PerMeasured};

/// How one kind of log is written.
#[derive(Debug, PartialEq)]
pub struct Preset {
    /// Its name on the command line.
    pub name: &'static str,
    /// Which logs it is for, and which shaft their angle is of.
    pub about: &'static str,
    /// What the command sets.
    pub drive: DriveKind,
    /// The time.
    pub time: Names<TimeUnit>,
    /// The command.
    pub command: Names<CommandUnit>,
    /// The angle, or a speed.
    pub angle: Names<AngleUnit>,
    /// Measured columns.
    pub measured: &'static [Further],
    /// 0 while the bridge is open.
    pub enabled: &'static [&'static str],
    /// The direction of a command without a sign.
    pub direction: &'static [&'static str],
    /// Counts per revolution, where all of them have the same encoder.
    pub counts_per_rev: Option<f64>,
}

/// A column's names, and its unit.
#[derive(Debug, PartialEq)]
pub struct Names<U: 'static> {
    /// The names, the likeliest first.
    pub names: &'static [&'static str],
    /// The unit.
    pub unit: U,
}

/// A measured column's names, and the place of its unit among the channel's.
#[derive(Debug, PartialEq)]
pub struct Further {
    /// What it is.
    pub channel: Measured,
    /// The names, the likeliest first.
    pub names: &'static [&'static str],
    /// The unit's place.
    pub unit: usize,
}

/// A current in A.
const fn amperes(names: &'static [&'static str]) -> Further {
    Further {
        channel: Measured::Current,
        names,
        unit: 0,
    }
}

/// A current in mA.
const fn milliamperes(names: &'static [&'static str]) -> Further {
    Further {
        channel: Measured::Current,
        names,
        unit: 1,
    }
}

/// A temperature in °C.
const fn celsius(names: &'static [&'static str]) -> Further {
    Further {
        channel: Measured::Temperature,
        names,
        unit: 0,
    }
}

const fn column<U>(names: &'static [&'static str], unit: U) -> Names<U> {
    Names { names, unit }
}

/// Every preset.
pub const PRESETS: &[Preset] = &[
    Preset {
        name: "odrive",
        about: "ODrive: torque current and position of the motor's shaft, as odrivetool and the GUI log them",
        drive: DriveKind::Current,
        time: column(&["timestamp", "time", "t"], TimeUnit::Seconds),
        command: column(
            &[
                "Iq_setpoint",
                "iq_setpoint",
                "motor.foc.Iq_setpoint",
                "input_torque",
                "Iq_measured",
            ],
            CommandUnit::Amperes,
        ),
        angle: column(
            &[
                "pos_estimate",
                "encoder.pos_estimate",
                "pos_rel",
                "position",
            ],
            AngleUnit::Revolutions,
        ),
        measured: &[amperes(&["Iq_measured", "iq_measured"])],
        enabled: &[],
        direction: &[],
        counts_per_rev: None,
    },
    Preset {
        name: "vesc",
        about: "VESC Tool's CSV: voltage in the q axis, and the tachometer of the motor's shaft (6 counts an electrical turn)",
        drive: DriveKind::Voltage,
        time: column(&["ms_today"], TimeUnit::Milliseconds),
        command: column(&["q_axis_voltage"], CommandUnit::Volts),
        angle: column(&["tachometer"], AngleUnit::Counts),
        measured: &[
            amperes(&["q_axis_current", "current_motor"]),
            celsius(&["temp_motor"]),
        ],
        enabled: &[],
        direction: &[],
        counts_per_rev: None,
    },
    Preset {
        name: "moteus",
        about: "moteus: current in the q axis and position of the output, behind the configured gear",
        drive: DriveKind::Current,
        time: column(&["timestamp", "time"], TimeUnit::Seconds),
        command: column(
            &["control.i_q_A", "q_current", "q_A", "servo_stats.q_A"],
            CommandUnit::Amperes,
        ),
        angle: column(
            &[
                "position",
                "servo_stats.position",
                "motor_position.position",
            ],
            AngleUnit::Revolutions,
        ),
        measured: &[
            amperes(&["q_current", "q_A", "servo_stats.q_A"]),
            celsius(&["servo_stats.motor_temp_C", "motor_temp_C"]),
        ],
        enabled: &[],
        direction: &[],
        counts_per_rev: None,
    },
    Preset {
        name: "dynamixel",
        about: "Dynamixel X: PWM (885 is all of the supply) and position of the output, 4096 counts a turn",
        drive: DriveKind::Voltage,
        time: column(&["timestamp", "time", "t"], TimeUnit::Seconds),
        command: column(
            &["present_pwm", "Present_PWM", "goal_pwm"],
            CommandUnit::Pwm885,
        ),
        angle: column(&["present_position", "Present_Position"], AngleUnit::Counts),
        measured: &[
            milliamperes(&["present_current", "Present_Current"]),
            celsius(&["present_temperature", "Present_Temperature"]),
        ],
        enabled: &["torque_enable", "Torque_Enable"],
        direction: &[],
        counts_per_rev: Some(4096.0),
    },
    Preset {
        name: "bam",
        about: "Rhoban's bam: PWM of a Dynamixel (885 is all of the supply) and angle of the output",
        drive: DriveKind::Voltage,
        time: column(&["timestamp"], TimeUnit::Seconds),
        command: column(&["load", "pwm"], CommandUnit::Pwm885),
        angle: column(&["position"], AngleUnit::Radians),
        measured: &[],
        enabled: &["torque_enable"],
        direction: &[],
        counts_per_rev: Some(4096.0),
    },
    Preset {
        name: "sysid",
        about: "WPILib SysId: voltage and position of the mechanism, in rotations; radians or degrees by --unit angle=rad",
        drive: DriveKind::Voltage,
        time: column(&["time", "timestamp"], TimeUnit::Seconds),
        command: column(&["voltage"], CommandUnit::Volts),
        angle: column(&["position"], AngleUnit::Revolutions),
        measured: &[amperes(&["current"])],
        enabled: &[],
        direction: &[],
        counts_per_rev: None,
    },
    Preset {
        name: "lerobot",
        about: "LeRobot: a joint's target (action) and state, degrees of the output; name the joint by --column target=… and \
                --column angle=…",
        drive: DriveKind::Position,
        time: column(&["timestamp"], TimeUnit::Seconds),
        command: column(&["action", "action[0]"], CommandUnit::Volts),
        angle: column(
            &["observation.state", "observation.state[0]"],
            AngleUnit::Degrees,
        ),
        measured: &[],
        enabled: &[],
        direction: &[],
        counts_per_rev: None,
    },
    Preset {
        name: "px4",
        about: "PX4's esc_status as CSV: speed of the motor's shaft in rpm, and the first output in volts",
        drive: DriveKind::Voltage,
        time: column(&["timestamp"], TimeUnit::Microseconds),
        command: column(&["esc[0].esc_voltage", "output[0]"], CommandUnit::Volts),
        angle: column(
            &["esc[0].esc_rpm", "esc_rpm"],
            AngleUnit::Speed(SpeedUnit::RevolutionsPerMinute),
        ),
        measured: &[amperes(&["esc[0].esc_current", "esc_current"])],
        enabled: &[],
        direction: &[],
        counts_per_rev: None,
    },
    Preset {
        name: "arduino",
        about: "What sketches print: millis(), analogWrite's −255 … 255, and encoder counts",
        drive: DriveKind::Voltage,
        time: column(&["ms", "millis", "t", "time"], TimeUnit::Milliseconds),
        command: column(&["pwm", "duty", "u", "out", "output"], CommandUnit::Pwm8),
        angle: column(
            &[
                "counts", "count", "ticks", "encoder", "enc", "pos", "position",
            ],
            AngleUnit::Counts,
        ),
        measured: &[milliamperes(&["mA", "ma", "current_ma"])],
        enabled: &["enable", "enabled"],
        direction: &["dir", "direction"],
        counts_per_rev: None,
    },
];

impl Preset {
    /// The preset of this name.
    pub fn by_name(name: &str) -> Option<&'static Preset> {
        PRESETS.iter().find(|preset| preset.name == name)
    }

    /// The names of all.
    pub fn names() -> Vec<&'static str> {
        PRESETS.iter().map(|preset| preset.name).collect()
    }

    /// Its units.
    pub(super) fn units(&self) -> Units {
        Units {
            time: self.time.unit,
            voltage: self.command.unit,
            angle: self.angle.unit,
            measured: self.units_measured(),
            ..Units::default()
        }
    }

    fn units_measured(&self) -> PerMeasured<usize> {
        let mut units = PerMeasured::default();
        for further in self.measured {
            units[further.channel] = further.unit;
        }
        units
    }

    /// What it calls a channel's column, the likeliest first; nothing where it has none.
    pub(super) fn names_of(&self, channel: Channel) -> &'static [&'static str] {
        match channel {
            Channel::Time => self.time.names,
            Channel::Command => self.command.names,
            Channel::Angle => self.angle.names,
            Channel::Measured(channel) => {
                let mut all = self.measured.iter();
                let own = all.find(|further| further.channel == channel);
                own.map_or(&[], |further| further.names)
            }
            Channel::Enabled => self.enabled,
            Channel::Direction => self.direction,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn presets_have_names_of_their_own_and_units_that_fit_their_drives() {
        for (k, preset) in PRESETS.iter().enumerate() {
            assert!(PRESETS[..k].iter().all(|other| other.name != preset.name));
            assert!(!preset.about.is_empty() && !preset.about.ends_with('.'));
            let of_current = matches!(
                preset.command.unit,
                CommandUnit::Amperes | CommandUnit::Milliamperes | CommandUnit::NewtonMetres
            );
            assert_eq!(
                preset.drive == DriveKind::Current,
                of_current,
                "{}",
                preset.name
            );
            let needed = [preset.time.names, preset.command.names, preset.angle.names];
            assert!(
                needed.iter().all(|names| !names.is_empty()),
                "{}",
                preset.name
            );
        }
    }
}
