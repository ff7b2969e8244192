//! Rows that tell no angle. What they command acts all the same: in a short gap as the mean over the time between two readings, which
//! moves the motor as far up to the second order of that time; a longer gap parts the recording.

use super::samples::Samples;
use crate::median::median_interval;

/// A gap of so many usual intervals between readings is closed; in a longer one the mean of the commands would bend the motion.
const SHORT: f64 = 3.5;
/// A part of fewer readings tells too little to be kept.
const LEAST: usize = 20;

/// A logger pauses where no row comes for so many usual intervals, and so long, s.
const PAUSE: (f64, f64) = (20.0, 0.5);
/// More of them are a log that only tells changes.
const MOST_PAUSES: usize = 8;

/// The first samples after pauses in which nothing was logged.
pub(super) fn pauses(time_s: &[f64]) -> Vec<usize> {
    if time_s.len() < 2 {
        return Vec::new();
    }
    let least = (PAUSE.0 * median_interval(time_s)).max(PAUSE.1);
    let ends = (1..time_s.len()).filter(|k| time_s[*k] - time_s[k - 1] > least);
    let ends: Vec<usize> = ends.take(MOST_PAUSES + 1).collect();
    if ends.len() > MOST_PAUSES {
        return Vec::new();
    }
    ends
}

/// What was done about rows without an angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Closed {
    /// Rows without an angle.
    pub(super) rows: usize,
    /// Gaps that part the recording.
    pub(super) parted: usize,
}

/// Parts in which every sample has an angle.
pub(super) fn closed(mut samples: Samples) -> (Vec<Samples>, Closed) {
    let told: Vec<usize> = (0..samples.len())
        .filter(|k| !samples.counts[*k].is_nan())
        .collect();
    let mut done = Closed {
        rows: samples.len() - told.len(),
        parted: 0,
    };
    if done.rows == 0 {
        return (vec![samples], done);
    }
    if told.len() < 2 {
        return (Vec::new(), done);
    }
    let times: Vec<f64> = told.iter().map(|k| samples.time_s[*k]).collect();
    let usual = median_interval(&times);
    // Places among those that are told at which a part begins.
    let mut begins = vec![0];
    for (place, pair) in told.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        if to == from + 1 {
            continue;
        }
        let whole = samples.time_s[to] - samples.time_s[from];
        if whole > SHORT * usual {
            begins.push(place + 1);
            continue;
        }
        let held = (from..to).map(|k| {
            let seconds = samples.time_s[k + 1] - samples.time_s[k];
            samples.command[k] * seconds
        });
        let sum: f64 = held.sum();
        samples.command[from] = sum / whole;
    }
    let mut keep = vec![false; samples.len()];
    told.iter().for_each(|k| keep[*k] = true);
    samples.keep(&keep);
    done.parted = begins.len() - 1;
    begins.push(samples.len());
    let parts = begins.windows(2).map(|pair| pair[0]..pair[1]);
    let long = parts.filter(|part| part.len() >= LEAST.min(samples.len()));
    (long.map(|part| samples.rows(part)).collect(), done)
}
