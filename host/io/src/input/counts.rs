//! Angles to encoder counts, and the test whether they are whole counts.

use std::f64::consts::TAU;

use super::read_error::ReadFault;

/// How far a converted angle may lie from a whole count, in counts. Printing a log in single precision or with
/// few digits moves a reading by up to a few hundredths; readings of a continuous angle spread evenly, so
/// that all of n lie this near with probability 0.2ⁿ.
const SNAP_COUNTS: f64 = 0.1;

/// Readings needed before the test means anything: chance passes it once in ten million times.
const SNAP_SAMPLES: usize = 10;

/// Refuses a reading no 32-bit counter can hold.
pub(super) fn in_counter_range(counts: f64) -> Result<f64, ReadFault> {
    if counts >= f64::from(i32::MIN) && counts <= f64::from(i32::MAX) {
        // Adding zero turns -0 into 0.
        Ok(counts + 0.0)
    } else {
        Err(ReadFault::BeyondCounter { counts })
    }
}

/// Snaps converted angles to whole counts if they are whole counts plus one common fraction (an angle zeroed
/// between two counts); the fraction is dropped, since a recording starts anywhere. Returns the fraction, `None` where they
/// are not whole.
///
/// The common fraction is the circular mean of the readings' fractions, which no reading's own error can turn.
pub(super) fn snap_to_whole(counts: &mut [f64]) -> Option<f64> {
    let fraction = common_fraction(counts);
    let distance = |x: f64| (x - fraction - (x - fraction).round()).abs();
    let first = counts.first().map_or(0.0, |x| (x - fraction).round());
    let moved = counts.iter().any(|x| (x - fraction).round() != first);
    if !moved || counts.len() < SNAP_SAMPLES || counts.iter().any(|x| distance(*x) > SNAP_COUNTS) {
        return None;
    }
    for x in counts {
        *x = (*x - fraction).round() + 0.0;
    }
    Some(fraction)
}

/// Rounds steps that are whole counts, as near as an angle must be to be taken for whole; false where they are not whole, and are
/// left as they are.
pub(super) fn whole_steps(steps: &mut [f64]) -> bool {
    let off = |step: &f64| (step - step.round()).abs() > SNAP_COUNTS;
    let moved = steps.iter().any(|step| step.round() != 0.0);
    if !moved || steps.len() < SNAP_SAMPLES || steps.iter().any(off) {
        return false;
    }
    for step in steps {
        *step = step.round() + 0.0;
    }
    true
}

/// Circular mean of the fractions, −0.5 … 0.5 counts.
fn common_fraction(counts: &[f64]) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for x in counts {
        let (s, c) = libm::sincos(TAU * x.fract());
        sine += s;
        cosine += c;
    }
    libm::atan2(sine, cosine) / TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whole counts printed with few digits and zeroed anywhere are found again.
        #[test]
        fn whole_counts_are_found(
            whole in prop::collection::vec(-100_000i32..100_000, 10..200),
            offset in -3.0f64..3.0,
            errors in prop::collection::vec(-0.04f64..0.04, 200),
        ) {
            prop_assume!(whole.iter().any(|x| x != &whole[0]));
            let mut counts: Vec<f64> =
                whole.iter().zip(&errors).map(|(x, error)| f64::from(*x) + offset + error).collect();
            prop_assert!(snap_to_whole(&mut counts).is_some());
            for (x, y) in whole.iter().zip(&counts) {
                prop_assert_eq!(y - counts[0], f64::from(*x) - f64::from(whole[0]));
                prop_assert_eq!(y.fract(), 0.0);
            }
        }

        /// A continuous angle is left alone, to the bit.
        #[test]
        fn a_continuous_angle_stays(step in 0.21f64..0.79, start in -100.0f64..100.0) {
            let ramp: Vec<f64> = (0..50).map(|k| start + step * f64::from(k)).collect();
            let mut counts = ramp.clone();
            prop_assert_eq!(snap_to_whole(&mut counts), None);
            prop_assert_eq!(counts, ramp);
        }
    }

    #[test]
    fn too_little_to_tell_is_left_alone() {
        assert_eq!(snap_to_whole(&mut []), None);
        assert_eq!(snap_to_whole(&mut [1.0, 2.0, 3.0]), None);
        assert_eq!(snap_to_whole(&mut [0.25; 100]), None);
    }
}
