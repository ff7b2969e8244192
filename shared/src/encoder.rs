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

/// Cumulative count of a position that is read in `BITS` bits and wraps: a hardware counter, or an absolute angle, of which one
/// revolution is `2^BITS` counts.
///
/// Exact while less than half a wrap, `2^(BITS - 1)` counts, passes between two readings. A larger step cannot be known: it is
/// taken for the shorter way round, and nothing in the readings tells. A step of just half a wrap is taken backwards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unwrapped<const BITS: u32> {
    count: i32,
}

impl<const BITS: u32> Unwrapped<BITS> {
    /// Bits of an `i32` above the reading's.
    const ABOVE: u32 = {
        assert!(0 < BITS && BITS <= 32, "a reading has 1 to 32 bits");
        32 - BITS
    };

    /// Takes a reading, of which bits above `BITS` are ignored; gives the count.
    pub fn read(&mut self, reading: u32) -> i32 {
        let ahead = reading.wrapping_sub(self.count.cast_unsigned());
        // The highest bit of the difference is its sign.
        let step = (ahead << Self::ABOVE).cast_signed() >> Self::ABOVE;
        self.count = self.count.wrapping_add(step);
        self.count
    }

    /// The count at the latest reading; zero before the first.
    pub fn count(&self) -> i32 {
        self.count
    }
}

/// Extends a 16-bit hardware counter to 32 bits. Exact while less than half a wrap (32,768 counts)
/// passes between two readings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extended(Unwrapped<16>);

impl Extended {
    /// Takes a reading of the hardware counter, gives the 32-bit count.
    pub fn read(&mut self, hardware: u16) -> i32 {
        self.0.read(hardware.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_core::Rng;

    #[test]
    fn an_extended_counter_follows_any_path_of_short_steps() {
        let mut counter = Extended::default();
        let mut truth = 0i32;
        for k in 0..200_000i32 {
            truth = truth.wrapping_add((k.wrapping_mul(7919) % 30_000) - 11_000);
            assert_eq!(counter.read(truth as u16), truth);
        }
    }

    /// Follows a random walk of any steps below half a wrap, then the largest ones both ways, through both ends of `i32`.
    fn walks<const BITS: u32>(seed: u64) {
        let mut random = crate::rng::seeded(seed);
        let half = 1i64 << (BITS - 1);
        let drawn = |_| i64::from(random.next_u32()) % (2 * half) - half;
        let mut steps: Vec<i64> = (0..10_000).map(drawn).collect();
        for largest in [half - 1, -half] {
            steps.extend([largest; 10_000]);
        }
        let mut position = Unwrapped::<BITS>::default();
        let mut truth = 0i32;
        for step in steps {
            truth = truth.wrapping_add(step as i32);
            let reading = u64::from(truth.cast_unsigned()) % (1 << BITS);
            // What a driver leaves above the reading's bits must not matter.
            let above = u64::from(random.next_u32()) << BITS;
            let count = position.read((reading | above) as u32);
            assert_eq!(count, truth, "{BITS} bits, seed {seed}, step {step}");
            assert_eq!(position.count(), truth);
        }
    }

    #[test]
    fn an_unwrapped_angle_follows_any_walk_of_steps_below_half_a_revolution() {
        let seed = 20_261;
        println!("seed {seed}");
        walks::<1>(seed);
        walks::<3>(seed);
        walks::<12>(seed);
        walks::<14>(seed);
        walks::<16>(seed);
        walks::<18>(seed);
        walks::<24>(seed);
        walks::<31>(seed);
        walks::<32>(seed);
    }

    #[test]
    fn an_unwrapped_angle_wraps_at_the_ends_of_the_count() {
        let mut position = Unwrapped::<24>::default();
        let mut truth = 0i32;
        let step = (1 << 23) - 1;
        // Twice through all of `i32`.
        for _ in 0..1100 {
            truth = truth.wrapping_add(step);
            assert_eq!(position.read(truth.cast_unsigned() & 0xFF_FFFF), truth);
        }
    }

    #[test]
    fn a_step_of_half_a_revolution_or_more_is_taken_for_the_shorter_way() {
        for beyond in 0..2000 {
            let mut position = Unwrapped::<14>::default();
            assert_eq!(position.read(8192 + beyond), 8192 + beyond as i32 - 16_384);
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
