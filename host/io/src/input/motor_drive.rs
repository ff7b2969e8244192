//! `[drive]` of a motor file: what the command sets, and the loop behind it.

use super::motor_error::{MotorFault, MotorFileError};
use super::motor_file::MotorFile;
use super::motor_units::CommandUnit;
use super::section::{Found, Section};
use crate::channel::Channel;
use crate::position_loop::LoopSettings;
use crate::recording::Drive;

/// Keys of `[drive]`.
pub(super) const DRIVE_KEYS: [&str; 6] = [
    "kind",
    "gain_v_per_rad",
    "damping_v_s_per_rad",
    "limit_v",
    "dead_band_rad",
    "rate_hz",
];

/// What the command sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriveKind {
    /// A voltage.
    Voltage,
    /// A current, behind which the amplifier closes a loop.
    Current,
    /// A target angle, behind which the drive closes a loop with a voltage.
    Position,
}

impl DriveKind {
    const ALL: &'static [(&'static str, DriveKind)] = &[
        ("voltage", DriveKind::Voltage),
        ("current", DriveKind::Current),
        ("position", DriveKind::Position),
    ];

    /// Its name in files and flags.
    pub fn name(self) -> &'static str {
        match self {
            DriveKind::Voltage => "voltage",
            DriveKind::Current => "current",
            DriveKind::Position => "position",
        }
    }

    /// What the motor gets.
    pub(super) fn of_motor(self) -> Drive {
        match self {
            DriveKind::Voltage | DriveKind::Position => Drive::Voltage,
            DriveKind::Current => Drive::Current,
        }
    }

    /// The command's key under `[columns]` and `[units]`.
    pub fn command_key(self) -> &'static str {
        match self {
            DriveKind::Position => "target",
            _ => "voltage",
        }
    }

    /// A channel's key under `[columns]` and `[units]`.
    pub fn key(self, channel: Channel) -> &'static str {
        match channel {
            Channel::Command => self.command_key(),
            channel => channel.facts().key,
        }
    }

    /// Refuses the key of another kind's command under `[columns]` or `[units]`.
    pub(super) fn refuses_other_key(self, section: &Section<'_>) -> Result<(), MotorFileError> {
        let (key, remedy) = match self {
            DriveKind::Position => (
                "voltage",
                "its command is an angle: write `target` in place of `voltage`",
            ),
            _ => (
                "target",
                "write kind = \"position\" under [drive] (or --drive position), or `voltage` in place of `target`",
            ),
        };
        match section.span_of(key) {
            None => Ok(()),
            Some(span) => Err(section.error(
                &span,
                MotorFault::NotOfDrive {
                    key,
                    kind: self.name(),
                    remedy,
                },
            )),
        }
    }
}

impl MotorFile {
    /// What the motor gets by the command as it is recorded.
    pub(super) fn recorded_drive(&self) -> Drive {
        match (self.drive, self.units.voltage) {
            (Drive::Current, CommandUnit::NewtonMetres) => Drive::Torque,
            (drive, _) => drive,
        }
    }

    /// What the command sets.
    pub fn drive_kind(&self) -> DriveKind {
        match (self.drive, self.position) {
            (Drive::Current | Drive::Torque, _) => DriveKind::Current,
            (Drive::Voltage, None) => DriveKind::Voltage,
            (Drive::Voltage, Some(_)) => DriveKind::Position,
        }
    }
}

/// The kind, the `usual` one if not said, whether it is said, and with a position drive what is said of its loop.
pub(super) fn drive(
    mut section: Section<'_>,
    usual: DriveKind,
) -> Result<(DriveKind, bool, Option<LoopSettings>), MotorFileError> {
    let kind = section.word("kind", DriveKind::ALL)?;
    let said = kind.is_some();
    let kind = kind.map_or(usual, |found| found.value);
    let mut first = None;
    let mut number = |key: &'static str| -> Result<Option<f64>, MotorFileError> {
        let Some(Found { value, span }) = section.positive(key)? else {
            return Ok(None);
        };
        first.get_or_insert((key, span));
        Ok(Some(value))
    };
    let settings = LoopSettings {
        gain_v_per_rad: number("gain_v_per_rad")?,
        damping_v_s_per_rad: number("damping_v_s_per_rad")?,
        limit_v: number("limit_v")?,
        dead_band_rad: number("dead_band_rad")?,
        rate_hz: number("rate_hz")?,
    };
    if let (Some((key, span)), true) = (first, kind != DriveKind::Position) {
        let remedy = "it is a position loop's: write kind = \"position\" under [drive] (or --drive position), or leave the \
                      key out";
        let fault = MotorFault::NotOfDrive {
            key,
            kind: kind.name(),
            remedy,
        };
        return Err(section.error(&span, fault));
    }
    section.finish(|key| super::motor_parse::home_of(key, "drive"))?;
    Ok((
        kind,
        said,
        (kind == DriveKind::Position).then_some(settings),
    ))
}
