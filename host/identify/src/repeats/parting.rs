//! How far repeats part, without any model.

use super::aligned::{Group, Repeats};

/// How far the runs of one command part: RMS deviation of a run from their mean, counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Parting {
    /// Where the runs were recorded.
    pub sources: Vec<String>,
    /// How many there are: recordings, or periods of one.
    pub runs: usize,
    /// Length of the windows, s.
    pub window_s: f64,
    /// Within windows, each from where it begins.
    pub in_windows: f64,
    /// Over whole runs, each from where it begins.
    pub over_run: f64,
}

impl Repeats<'_> {
    /// How far the runs of each command part, in windows of `window_s` and as a whole.
    pub fn partings(&self, window_s: f64) -> Vec<Parting> {
        let parting = |group: &Group<'_>| Parting {
            sources: group.sources(),
            runs: group.members.len(),
            window_s,
            in_windows: deviation(std::slice::from_ref(group), |group| group.window(window_s)),
            over_run: deviation(std::slice::from_ref(group), |group| group.common),
        };
        self.groups.iter().map(parting).collect()
    }

    /// RMS deviation of a whole run from the mean of its repeats, counts.
    pub(super) fn over_run(&self) -> f64 {
        deviation(&self.groups, |group| group.common)
    }
}

/// RMS deviation of a run from the mean of its repeats, each moved to one angle at the begin of each window of so many samples.
fn deviation(groups: &[Group<'_>], window: impl Fn(&Group<'_>) -> usize) -> f64 {
    let (mut squares, mut freedom) = (0.0, 0.0);
    for group in groups {
        let window = window(group).max(1);
        let runs = group.members.len() as f64;
        for k in 0..group.common {
            let begin = k - k % window;
            let moved = group.members.iter().map(|member| {
                let counts = &member.data.counts[member.first..];
                counts[k] - counts[begin]
            });
            let mean = moved.clone().sum::<f64>() / runs;
            squares += moved.map(|moved| (moved - mean).powi(2)).sum::<f64>();
        }
        freedom += group.common as f64 * (runs - 1.0);
    }
    (squares / freedom).sqrt()
}
