//! Time stamps that repeat. Rows of one stamp that complement each other are one; of whole milliseconds above 1 kHz they are spread evenly.

use super::samples::Samples;

/// Even times may be so many ticks of the clock off the stamps.
const WITHIN: f64 = 1.5;
/// Fewer rows tell no even times.
const FEWEST: usize = 20;
/// Copies of rows may be so small a part of all.
const COPIES: f64 = 0.02;

/// What was done about stamps that repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spread {
    /// Rows were given even times.
    Even {
        /// Rows whose stamp is that of the row before.
        repeated: usize,
        /// The clock's tick, s.
        tick_s: f64,
        /// Time between rows, s.
        interval_s: f64,
    },
    /// Copies of the row before were left out.
    Copies(usize),
    /// So many rows complement the one before with the same stamp, which tells an angle where this one does not, or the other way round.
    Merged(usize),
}

/// Makes one row of each two with the same stamp of which one alone tells an angle; `None` where others repeat a stamp.
fn merged(samples: &mut Samples) -> Option<Spread> {
    let mut counts = samples.counts.clone();
    let mut keep = vec![true; samples.len()];
    for k in 1..samples.len() {
        if samples.time_s[k] != samples.time_s[k - 1] {
            continue;
        }
        let [before, own] = [counts[k - 1], counts[k]];
        if before.is_nan() == own.is_nan() {
            return None;
        }
        // The later row has the command that holds from this stamp on.
        keep[k - 1] = false;
        counts[k] = if own.is_nan() { before } else { own };
    }
    let rows = keep.iter().filter(|keep| !**keep).count();
    // Rows that all have commands of their own are of a clock that is too coarse for them.
    let held = samples.held_commands.checked_sub(rows as u64)?;
    samples.counts = counts;
    samples.held_commands = held;
    samples.keep(&keep);
    Some(Spread::Merged(rows))
}

/// Makes times increase where some repeat; `None` where they cannot be told.
pub(super) fn spread(samples: &mut Samples) -> Option<Spread> {
    if samples.counts.iter().any(|counts| counts.is_nan())
        && let Some(merged) = merged(samples)
    {
        return Some(merged);
    }
    let time = &samples.time_s;
    let repeated = time.windows(2).filter(|pair| pair[1] == pair[0]).count();
    let is_copy = |k: &usize| {
        let k = *k;
        k > 0
            && time[k] == time[k - 1]
            && samples.command[k] == samples.command[k - 1]
            && samples.counts[k] == samples.counts[k - 1]
    };
    let steps = time.windows(2).map(|pair| pair[1] - pair[0]);
    let tick_s = steps.filter(|step| *step > 0.0).reduce(f64::min)?;
    let count = time.len();
    let interval_s = even(time)?;
    let (first, last) = (time[0], time[count - 1]);
    let mean = (0..count).map(|k| time[k] - first - interval_s * k as f64);
    let offset = mean.sum::<f64>() / count as f64;
    let at = |k: usize| first + offset + interval_s * k as f64;
    if count >= FEWEST
        && last > first
        && (0..count).all(|k| (time[k] - at(k)).abs() <= WITHIN * tick_s)
    {
        samples.time_s = (0..count).map(at).collect();
        return Some(Spread::Even {
            repeated,
            tick_s,
            interval_s,
        });
    }
    let copies = (0..count).filter(is_copy).count();
    if copies == repeated && copies as f64 <= COPIES * count as f64 {
        let keep: Vec<bool> = (0..count).map(|k| !is_copy(&k)).collect();
        samples.keep(&keep);
        return Some(Spread::Copies(copies));
    }
    None
}

/// The time between rows if they are even: the slope of the line through the stamps.
fn even(time: &[f64]) -> Option<f64> {
    let count = time.len() as f64;
    let middle = (count - 1.0) / 2.0;
    let (mut above, mut below) = (0.0, 0.0);
    for (k, stamp) in time.iter().enumerate() {
        let from = k as f64 - middle;
        above += from * (stamp - time[0]);
        below += from * from;
    }
    (below > 0.0 && above > 0.0).then(|| above / below)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(time_s: Vec<f64>) -> Samples {
        let values: Vec<f64> = (0..time_s.len()).map(|k| k as f64).collect();
        Samples {
            time_s,
            command: values.clone(),
            counts: values,
            ..Samples::default()
        }
    }

    #[test]
    fn whole_milliseconds_above_a_kilohertz_are_spread() {
        for rate in [1250.0, 2000.0, 3333.0] {
            let stamps = (0..5000).map(|k| f64::floor(1e3 * f64::from(k) / rate) / 1e3);
            let mut rows = samples(stamps.collect());
            let Some(Spread::Even { interval_s, .. }) = spread(&mut rows) else {
                panic!("{rate} Hz");
            };
            assert!(
                (interval_s * rate - 1.0).abs() < 1e-4,
                "{rate}: {interval_s}"
            );
            assert!(rows.time_s.windows(2).all(|pair| pair[1] > pair[0]));
        }
    }

    #[test]
    fn rows_that_complement_each_other_are_one_and_others_are_spread() {
        let stamps: Vec<f64> = (0..2000).map(|k| f64::from(k / 2) * 1e-3).collect();
        let mut rows = samples(stamps);
        for k in (0..2000).step_by(2) {
            rows.counts[k] = f64::NAN;
        }
        // An angle at every other row of a log at 2 kHz.
        assert!(matches!(
            spread(&mut rows.clone()),
            Some(Spread::Even { .. })
        ));
        rows.held_commands = 1000;
        assert_eq!(spread(&mut rows), Some(Spread::Merged(1000)));
        assert_eq!((rows.len(), rows.held_commands), (1000, 0));
        assert!(rows.counts.iter().all(|counts| !counts.is_nan()));
    }

    #[test]
    fn copies_are_left_out_and_what_cannot_be_told_is_refused() {
        let mut time: Vec<f64> = (0..1000)
            .map(|k| f64::from(k) * 0.001 + f64::from(k / 100))
            .collect();
        time[500] = time[499];
        let mut rows = samples(time.clone());
        assert_eq!(spread(&mut rows.clone()), None);
        rows.command[500] = rows.command[499];
        rows.counts[500] = rows.counts[499];
        assert_eq!(spread(&mut rows), Some(Spread::Copies(1)));
        assert_eq!(rows.len(), 999);
    }
}
