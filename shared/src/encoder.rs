//! The incremental encoder: it rounds down to whole counts and its counter wraps.

use crate::scalar::{Readable, Real};

/// Quantisation floor of an encoder that rounds, in counts RMS: no model of the motion can leave
/// less than `1/√12` of a count between itself and the reading.
pub const FLOOR_RMS_COUNTS: f64 = 0.288_675_134_594_812_9;

/// Mean distance of a floored reading below the true angle, in counts.
pub const FLOOR_OFFSET_COUNTS: f64 = 0.5;

/// Reading of a 32-bit counter at `angle` (rad).
pub fn reading<R: Real>(angle: R, counts_per_rev: u32) -> i32 {
    let counts = angle.to_f64() * counts_per_rev as f64 / core::f64::consts::TAU;
    Readable::<f64>::floor(counts)
}

/// Counts travelled between two readings of a 32-bit counter that may have wrapped.
pub fn travelled(from: i32, to: i32) -> i32 {
    to.wrapping_sub(from)
}

/// Extends a 16-bit hardware counter to 32 bits. Exact while less than half a wrap (32,767 counts)
/// passes between two readings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extended {
    count: i32,
}

impl Extended {
    /// Takes a reading of the hardware counter, gives the 32-bit count.
    pub fn read(&mut self, hardware: u16) -> i32 {
        let step = hardware.wrapping_sub(self.count as u16) as i16;
        self.count = self.count.wrapping_add(step as i32);
        self.count
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extended_counter_follows_any_path_of_short_steps() {
        let mut counter = Extended::default();
        let mut truth = 0i32;
        for k in 0..200_000i32 {
            truth = truth.wrapping_add((k.wrapping_mul(7919) % 30_000) - 11_000);
            assert_eq!(counter.read(truth as u16), truth);
        }
    }

    #[test]
    fn a_reading_is_never_above_the_angle_and_never_a_count_below() {
        for k in -5000..5000 {
            let angle = k as f64 * 0.001_37;
            let counts = angle * 360.0 / core::f64::consts::TAU;
            let below = counts - reading(angle, 360) as f64;
            assert!(
                (0.0..1.0).contains(&below),
                "{angle} rad is {below} counts above its reading"
            );
        }
    }
}
