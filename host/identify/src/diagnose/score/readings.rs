//! At which readings an observer corrects a model, and what each of them weighs.

use super::settings::{LEAST_SAMPLES, LONGEST_S, REST_READINGS, REST_S, STILL, TIME_ROUNDING};
use crate::diagnose::context::noise_counts;
use servoid_engine::problem::Data;
use std::ops::Range;

/// The readings of one or several recordings at which an observer corrects.
pub struct Readings<'a> {
    /// The recordings.
    pub data: &'a Data,
    /// The samples, in rising order.
    pub samples: Vec<usize>,
    /// Whether the motor rests at each of them.
    pub at_rest: Vec<bool>,
    /// What each weighs, from 0 to 1.
    pub weights: Vec<f64>,
    /// The readings of each recording, places in `samples`.
    pub recordings: Vec<Range<usize>>,
    /// Variance of a reading that quantisation or the sensor makes, counts².
    pub floor: f64,
}

impl<'a> Readings<'a> {
    /// Readings about `interval_s` apart, which is confined to what is useful.
    pub fn every(data: &'a Data, interval_s: f64) -> Self {
        let least = LEAST_SAMPLES * data.units.interval;
        let interval = interval_s.clamp(least, LONGEST_S.max(least));
        let noise = noise_counts(data);
        let still = if data.quantised { 1.0 } else { STILL * noise };
        let mut readings = Readings {
            data,
            samples: Vec::new(),
            at_rest: Vec::new(),
            weights: Vec::new(),
            recordings: Vec::new(),
            floor: (noise * noise).max(f64::MIN_POSITIVE),
        };
        for range in data.recordings.ranges().filter(|range| !range.is_empty()) {
            let first = readings.samples.len();
            let mut next = data.time_s[range.start];
            for k in range.clone() {
                if data.time_s[k] >= next - TIME_ROUNDING * data.units.interval {
                    readings.samples.push(k);
                    readings.at_rest.push(rests(data, k, range.clone(), still));
                    next += interval * ((data.time_s[k] - next) / interval).floor().max(0.0);
                    next += interval;
                }
            }
            let own = first..readings.samples.len();
            readings
                .weights
                .extend(weights(&readings.at_rest[own.clone()]));
            readings.recordings.push(own);
        }
        readings
    }

    /// Model minus measured angle at the readings, counts, from model minus reading at every sample.
    pub fn errors(&self, all: &[f64]) -> Vec<f64> {
        let centre = self.data.half_cell();
        self.samples.iter().map(|&k| all[k] - centre).collect()
    }

    /// How many readings they weigh together.
    pub fn weight(&self) -> f64 {
        self.weights.iter().sum()
    }
}

/// Whether the angle stays within `still` counts around sample `k`.
fn rests(data: &Data, k: usize, recording: Range<usize>, still: f64) -> bool {
    let half = (REST_S / data.units.interval).round().max(1.0) as usize;
    let near = k.saturating_sub(half).max(recording.start)..(k + half + 1).min(recording.end);
    let (low, high) = data.counts[near]
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &count| {
            (low.min(count), high.max(count))
        });
    high - low <= still
}

/// The first reading tells nothing but where the run starts; each rest weighs as much as a few readings.
fn weights(at_rest: &[bool]) -> Vec<f64> {
    let mut weights = Vec::with_capacity(at_rest.len());
    for rest in at_rest.chunk_by(|one, next| one == next) {
        let weight = if rest[0] {
            (REST_READINGS / rest.len() as f64).min(1.0)
        } else {
            1.0
        };
        weights.extend(std::iter::repeat_n(weight, rest.len()));
    }
    if let Some(first) = weights.first_mut() {
        *first = 0.0;
    }
    weights
}
