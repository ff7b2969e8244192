//! How far a model runs on its own, and what is known of where it starts.

use super::propagator::Mode;
use crate::data::Data;
use std::ops::Range;
use std::sync::Arc;

/// How long the model runs before it is set back to the measurement.
#[derive(Clone, Debug, PartialEq)]
pub enum Horizon {
    /// Never: from the first sample of each recording to its last, the open-loop error.
    Whole,
    /// In windows, each started from the measured angle and speed.
    Windows(Vec<Window>),
    /// An observer pulls it towards the measurement; it forgets an error within so many seconds.
    Observer(f64),
    /// An observer corrects it at some samples, by gains that were computed before; in between it runs on its own. So the error
    /// at such a sample, before it is corrected, is an innovation.
    Corrected(Arc<[Correction]>),
}

/// What an observer changes at one sample for each count by which the model's encoder angle lies above the measured one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// The sample.
    pub sample: usize,
    /// Taken from the angle, counts a count.
    pub angle: f64,
    /// Taken from the speed, per-unit speed a count.
    pub speed: f64,
}

/// One window of a [`Horizon`].
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Its samples.
    pub range: Range<usize>,
    /// Measured angle at its first sample, counts.
    pub angle: f64,
    /// Measured speed there, rad/s.
    pub speed: f64,
}

impl Horizon {
    /// How a model is propagated along it.
    pub(crate) fn mode(&self) -> Mode<'_> {
        match self {
            Horizon::Observer(memory_s) => Mode::Observer(*memory_s),
            Horizon::Corrected(corrections) => Mode::Corrected(corrections),
            Horizon::Whole | Horizon::Windows(_) => Mode::Free,
        }
    }

    /// Windows of `seconds`, s, each started at the [measured state](Data::measured_state) of its first sample.
    pub fn windows(data: &Data, seconds: f64) -> Self {
        let mut ranges = Vec::new();
        let mut from = 0;
        while from + 1 < data.len() {
            let last = data.recordings.holding(from).end;
            let end = data.time_s[from] + seconds;
            let to = from + data.time_s[from..last].partition_point(|&t| t < end);
            let to = to.max(from + 2);
            // A last sample alone would be in no window.
            let to = if to + 1 < last { to } else { last };
            ranges.push(from..to);
            from = to;
        }
        Horizon::windows_over(data, ranges)
    }

    /// The same over given samples.
    pub fn windows_over(data: &Data, ranges: impl IntoIterator<Item = Range<usize>>) -> Self {
        let started = |range: Range<usize>| {
            let (angle, counts_s) = data.measured_state(range.start);
            Window {
                range,
                angle,
                speed: counts_s / data.units.counts_per_rev * core::f64::consts::TAU,
            }
        };
        Horizon::Windows(ranges.into_iter().map(started).collect())
    }
}

/// What is known of the angle at the first sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartAngle {
    /// The lower edge of the encoder's first cell, as in the paper.
    Known,
    /// Anywhere in the first cell: each candidate takes its best offset.
    Free,
}
