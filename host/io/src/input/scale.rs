//! From the file's units to seconds, volts or amperes, and counts; checked once for a file.

use super::counts::in_counter_range;
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, CommandUnit, SpeedUnit};
use super::read_error::ReadFault;
use super::samples::Further;
use crate::channel::Measured;

/// Largest duty: all of the supply, and a little for a logger that scales by 255 of 256 or so.
const MOST_DUTY: f64 = 1.05;

/// The conversions of one file.
pub(super) struct Scale<'m> {
    motor: &'m MotorFile,
    /// Encoder counts per revolution.
    pub(super) counts_per_rev: f64,
    /// Volts of all of the supply, where the command is a share of it and no column tells the supply.
    supply_v: Option<f64>,
    /// Whether the command is a share of a supply that a column tells.
    pub(super) of_measured_supply: bool,
    angle_per_rev: f64,
    /// The same of target angles, where the command is one.
    target_per_rev: Option<f64>,
}

impl<'m> Scale<'m> {
    /// # Errors
    /// A number that the conversion needs is not known, or has no meaning.
    pub(super) fn new(motor: &'m MotorFile, further: &Further) -> Result<Self, ReadFault> {
        let named = || motor.called().to_string();
        let counts_per_rev = positive("counts_per_rev", motor.encoder_counts())?
            .ok_or_else(|| ReadFault::NoCountsPerRev { motor: named() })?;
        let supply_v = positive("supply_v", motor.supply_v)?;
        let is_share = motor.units.voltage.full_scale().is_some() && motor.position.is_none();
        let of_measured_supply = is_share && further.measured.contains(&Measured::Supply);
        if is_share && !of_measured_supply && supply_v.is_none() {
            return Err(ReadFault::NoSupply { motor: named() });
        }
        let metres = positive("metres_per_rev", motor.metres_per_rev)?;
        let per_rev = |unit: AngleUnit| {
            let metres = match unit {
                AngleUnit::Metres => {
                    metres.ok_or_else(|| ReadFault::NoMetresPerRev { motor: named() })?
                }
                _ => 1.0,
            };
            Ok(unit.per_revolution(counts_per_rev, metres))
        };
        let angle_per_rev = per_rev(motor.units.angle)?;
        let target_per_rev = (motor.position)
            .map(|_| per_rev(motor.units.of_target()))
            .transpose()?;
        Ok(Scale {
            motor,
            counts_per_rev,
            supply_v,
            of_measured_supply,
            angle_per_rev,
            target_per_rev,
        })
    }

    /// Seconds.
    pub(super) fn time(&self, time: f64) -> f64 {
        self.motor.units.time.seconds(time)
    }

    /// Volts, amperes where the command is a current, or counts where it is a target angle; a share of the supply where a column tells
    /// that.
    pub(super) fn command(&self, command: f64) -> Result<f64, ReadFault> {
        if let Some(per_rev) = self.target_per_rev {
            return in_counter_range(command / per_rev * self.counts_per_rev);
        }
        let unit = self.motor.units.voltage;
        let forward = match unit.full_scale() {
            Some(full) if command.abs() > MOST_DUTY * full => {
                return Err(ReadFault::DutyBeyondSupply {
                    duty: command,
                    full,
                    unit: unit.name(),
                });
            }
            Some(full) if self.of_measured_supply => command / full,
            Some(full) => command / full * self.supply_v.unwrap_or(1.0),
            None => match unit {
                CommandUnit::Millivolts | CommandUnit::Milliamperes => command / 1e3,
                _ => command,
            },
        };
        Ok(turned(forward, self.motor.units.reversed.voltage))
    }

    /// Counts, whole ones where the file says that it has counts. Where it has speeds, counts a second or a sample.
    pub(super) fn counts(&self, angle: f64) -> Result<f64, ReadFault> {
        let angle = turned(angle, self.motor.units.reversed.angle);
        match self.motor.units.angle {
            AngleUnit::Counts if angle.fract() != 0.0 => {
                let motor = self.motor.called().into();
                Err(ReadFault::FractionalCounts {
                    counts: angle,
                    motor,
                })
            }
            AngleUnit::Counts => in_counter_range(angle),
            AngleUnit::Speed(SpeedUnit::CountsPerSample) => Ok(angle),
            AngleUnit::Speed(_) => Ok(angle / self.angle_per_rev * self.counts_per_rev),
            _ => in_counter_range(angle / self.angle_per_rev * self.counts_per_rev),
        }
    }

    /// A measured value in its channel's own unit.
    pub(super) fn measured(&self, channel: Measured, value: f64) -> f64 {
        let units = &self.motor.units;
        turned(
            units.of(channel).own(value),
            units.reversed.measured[channel],
        )
    }

    /// Counts after which a word of so many bits begins anew, where the column holds a speed.
    pub(super) fn word(&self, bits: i32) -> f64 {
        2f64.powi(bits) / self.angle_per_rev * self.counts_per_rev
    }
}

fn turned(value: f64, reversed: bool) -> f64 {
    // Less than zero minus, so that no zero becomes negative.
    if reversed { 0.0 - value } else { value }
}

/// The motor file's own reader refuses such numbers, but a flag may have set one.
pub(super) fn positive(key: &'static str, value: Option<f64>) -> Result<Option<f64>, ReadFault> {
    match value {
        Some(value) if !(value.is_finite() && value > 0.0) => {
            Err(ReadFault::NotPositive { key, value })
        }
        value => Ok(value),
    }
}
