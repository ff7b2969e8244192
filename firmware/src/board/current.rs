//! An amplifier for the armature current behind an ADC: 1.65 V at zero, 100 mV/A, 12 bits of 3.3 V.

/// Readings that the zero is the mean of.
pub const ZERO_READINGS: u16 = 64;

/// The amplifier, by its reading at zero current.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CurrentSensor {
    /// Sum of [`ZERO_READINGS`] readings.
    zero: i32,
}

impl CurrentSensor {
    /// From readings while no current flows.
    pub fn new(mut reading: impl FnMut() -> u16) -> Self {
        CurrentSensor {
            zero: (0..ZERO_READINGS).map(|_| i32::from(reading())).sum(),
        }
    }

    /// Current of a reading, mA.
    pub fn ma(self, reading: u16) -> i32 {
        // 33,000 mA are 4,096 steps, and those are 64 times as fine here. Reduced, or the top of the range would overflow, and a
        // short circuit look like no current.
        (i32::from(reading) * i32::from(ZERO_READINGS) - self.zero) * 4_125 / 32_768
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reading_is_its_current_to_a_milliampere() {
        for zero in [0, 1, 2_000, 2_048, 4_095] {
            let sensor = CurrentSensor::new(|| zero);
            for reading in 0..4_096 {
                let exact = (f64::from(reading) - f64::from(zero)) * 33_000.0 / 4_096.0;
                let seen = f64::from(sensor.ma(reading));
                assert!(
                    (seen - exact).abs() <= 1.0,
                    "{reading} at a zero of {zero}: {seen}"
                );
            }
        }
    }
}
