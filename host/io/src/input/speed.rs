//! Speeds in an angle's place, integrated to counts.
//!
//! A controller that differentiates its own counter logs whole counts for each sample: their sum is the counter. What is not
//! whole is integrated by the trapezoidal rule, and is an angle whose error grows.

use super::counts::{in_counter_range, whole_steps};
use super::read_error::ReadFault;

/// Counts at each time from speeds in counts a second, or in counts since the sample before where `per_sample`; and whether they
/// are whole counts. They begin with zero.
pub(super) fn integrated(
    time_s: &[f64],
    speeds: &[f64],
    per_sample: bool,
) -> Result<(Vec<f64>, bool), ReadFault> {
    let steps = |k: usize| {
        if per_sample {
            speeds[k]
        } else {
            speeds[k] * (time_s[k] - time_s[k - 1])
        }
    };
    let mut increments: Vec<f64> = (1..speeds.len()).map(steps).collect();
    let whole = whole_steps(&mut increments);
    if !whole && !per_sample {
        for k in 1..speeds.len() {
            let mean = 0.5 * (speeds[k] + speeds[k - 1]);
            increments[k - 1] = mean * (time_s[k] - time_s[k - 1]);
        }
    }
    let mut angle = 0.0;
    let mut counts = Vec::with_capacity(speeds.len());
    counts.extend((!speeds.is_empty()).then_some(0.0));
    for increment in increments {
        angle += increment;
        counts.push(in_counter_range(angle)?);
    }
    Ok((counts, whole))
}

/// A speed is of a word that overflowed where a step is larger than this part of the word, and none is left once it is undone.
const OVERFLOWS: (f64, f64) = (0.6, 0.3);

/// Undoes the overflow of speeds that were kept in a `word` of so many counts a second; `None` where they show none. Gives how many times.
pub(super) fn without_overflow(speeds: &mut [f64], word: f64) -> Option<usize> {
    let half = 0.5 * word * (1.0 + 1e-9);
    let signed = speeds.iter().all(|speed| speed.abs() <= half);
    let unsigned = speeds
        .iter()
        .all(|speed| (0.0..=2.0 * half).contains(speed));
    let within = signed || unsigned;
    let large = |pair: &[f64]| (pair[1] - pair[0]).abs() > OVERFLOWS.0 * word;
    if !within || !speeds.windows(2).any(large) {
        return None;
    }
    let mut before = *speeds.first()?;
    // In a word without a sign the upper half is negative.
    let begins_below = before > half;
    let (mut turns, mut times) = (if begins_below { -word } else { 0.0 }, 0);
    let mut whole = Vec::with_capacity(speeds.len());
    for speed in speeds.iter() {
        let step = speed - before;
        before = *speed;
        if step.abs() > 0.5 * word {
            turns -= word * step.signum();
            times += 1;
        }
        whole.push(speed + turns);
    }
    let left = |pair: &[f64]| (pair[1] - pair[0]).abs() > OVERFLOWS.1 * word;
    if whole.windows(2).any(left) {
        return None;
    }
    speeds.copy_from_slice(&whole);
    Some(times)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The differences of a counter give the counter.
        #[test]
        fn differences_of_a_counter_give_it_back(
            steps in prop::collection::vec(-300i32..300, 20..200),
            interval in 1e-4f64..0.1,
        ) {
            prop_assume!(steps.iter().any(|step| *step != 0));
            let time: Vec<f64> = (0..=steps.len()).map(|k| interval * k as f64).collect();
            let mut counter = vec![0.0];
            for step in &steps {
                counter.push(counter[counter.len() - 1] + f64::from(*step));
            }
            let per_sample: Vec<f64> =
                std::iter::once(0.0).chain(steps.iter().map(|step| f64::from(*step))).collect();
            prop_assert_eq!(integrated(&time, &per_sample, true).unwrap(), (counter.clone(), true));
            let per_second: Vec<f64> = per_sample.iter().map(|step| step / interval).collect();
            prop_assert_eq!(integrated(&time, &per_second, false).unwrap(), (counter, true));
        }
    }

    #[test]
    fn speeds_of_sixteen_bits_are_unwrapped() {
        let whole: Vec<f64> = (0..500)
            .map(|k| (50_000.0 * libm::sin(0.02 * f64::from(k))).round())
            .collect();
        let word = 65_536.0;
        let wrap = |x: &f64| (x + 32_768.0).rem_euclid(word) - 32_768.0;
        let mut speeds: Vec<f64> = whole.iter().map(wrap).collect();
        assert_eq!(without_overflow(&mut speeds, word), Some(6));
        assert_eq!(speeds, whole);
        assert_eq!(without_overflow(&mut speeds, word), None);
        // Negative speeds in a word without a sign.
        let slow: Vec<f64> = whole
            .iter()
            .map(|speed| 0.01 * speed.round())
            .map(f64::round)
            .collect();
        let mut speeds: Vec<f64> = slow.iter().map(|speed| speed.rem_euclid(word)).collect();
        assert!(without_overflow(&mut speeds, word).is_some());
        assert_eq!(speeds, slow);
    }

    #[test]
    fn a_smooth_speed_is_integrated_by_the_trapezoidal_rule() {
        let time: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
        let speeds: Vec<f64> = time.iter().map(|t| 1000.0 * t).collect();
        let (counts, whole) = integrated(&time, &speeds, false).unwrap();
        assert!(!whole);
        assert!((counts[100] - 500.0).abs() < 1e-9, "{}", counts[100]);
    }
}
