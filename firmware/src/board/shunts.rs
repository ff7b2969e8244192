//! Shunts below the low sides of two legs. Each shows its leg's current while that low side conducts, which at the carrier's peak it does
//! unless the leg is high all the time: of the two, the leg that is high for less is read.

/// Readings that a zero is the mean of.
pub const ZERO_READINGS: u16 = 64;

/// Two shunts and their amplifiers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shunts {
    /// Current of a step of the ADC, µA, positive out of the leg.
    step_ua: i32,
    /// Sums of [`ZERO_READINGS`] readings of the legs A and B.
    zero: [i32; 2],
}

impl Shunts {
    /// From readings of both while no current flows.
    pub fn new(step_ua: i32, mut readings: impl FnMut() -> [u16; 2]) -> Self {
        let zero = (0..ZERO_READINGS).fold([0, 0], |[a, b], _| {
            let [reading_a, reading_b] = readings();
            [a + i32::from(reading_a), b + i32::from(reading_b)]
        });
        Shunts { step_ua, zero }
    }

    /// Armature current, mA, from leg A to leg B, by a reading of each; `forward` if leg A is high for longer.
    pub fn ma(self, readings: [u16; 2], forward: bool) -> i32 {
        let [a, b] = [0, 1].map(|leg: usize| {
            let zero = self.zero.get(leg).copied().unwrap_or(0);
            let reading = readings.get(leg).copied().unwrap_or(0);
            i64::from(i32::from(reading) * i32::from(ZERO_READINGS) - zero)
        });
        let out_of_a = if forward { -b } else { a };
        (out_of_a * i64::from(self.step_ua) / (1000 * i64::from(ZERO_READINGS))) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_leg_that_is_low_for_longer_tells_the_current_of_both() {
        for step_ua in [80_566, -29_372] {
            let zero = [2_040, 2_051];
            let shunts = Shunts::new(step_ua, || zero);
            for steps in -2_000..2_000_i32 {
                let current = f64::from(steps) * f64::from(step_ua) / 1000.0;
                // Out of leg A and into leg B; the other reading is of a low side that does not conduct.
                let out_of_a = [(i32::from(zero[0]) + steps) as u16, zero[1]];
                let into_b = [zero[0], (i32::from(zero[1]) - steps) as u16];
                assert!((f64::from(shunts.ma(out_of_a, false)) - current).abs() <= 1.0);
                assert!((f64::from(shunts.ma(into_b, true)) - current).abs() <= 1.0);
            }
        }
    }
}
