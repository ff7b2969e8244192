//! Duties of a device as volts.

use crate::schema::DeviceRun;
use shared::trace::{DUTY, OPEN};

/// What a device's duties are worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DutyScale {
    /// V.
    pub supply_v: f64,
    /// Duty that puts the whole supply across the winding.
    pub full: u16,
}

impl DutyScale {
    /// Voltage of a duty, V.
    pub fn volts(self, duty: i16) -> f64 {
        f64::from(duty) * (self.supply_v / f64::from(self.full))
    }

    /// Voltage of a recorded duty, V: none where the bridge was open.
    pub fn recorded(self, duty: i16) -> f64 {
        if duty == OPEN { 0.0 } else { self.volts(duty) }
    }

    /// The duty next to a voltage; beyond what 16 bits hold if the voltage is.
    pub fn duty(self, volts: f64) -> f64 {
        (volts / self.supply_v * f64::from(self.full)).round()
    }

    /// The largest duty there is.
    pub fn largest(self) -> i16 {
        i16::try_from(self.full).unwrap_or(i16::MAX)
    }

    /// The voltage that the device's model has for its unit, V: its arithmetic takes every duty for a Q15 fraction.
    pub fn unit_v(self) -> f64 {
        self.supply_v / (f64::from(self.full) * DUTY)
    }
}

impl DeviceRun {
    /// What the device's duties are worth.
    pub fn scale(&self) -> DutyScale {
        DutyScale {
            supply_v: self.supply_v,
            full: self.full_duty,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_duty_comes_back_from_its_voltage_and_the_full_one_is_the_supply() {
        for full in [1, 16_800, 17_000, 25_000, 32_767, 32_768] {
            for supply_v in [0.1, 6.0, 23.7, 400.0] {
                let scale = DutyScale { supply_v, full };
                for duty in -scale.largest()..=scale.largest() {
                    assert_eq!(scale.duty(scale.volts(duty)), f64::from(duty), "{scale:?}");
                }
                assert!(
                    (scale.unit_v() * f64::from(full) * DUTY - supply_v).abs() < 1e-9 * supply_v
                );
            }
        }
    }
}
