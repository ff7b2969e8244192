//! The likelihood of innovations.

use super::gains::Filter;
use super::readings::Readings;
use super::settings::{FEWEST, MOST_LAGS};
use crate::likelihood::{HUBER, huber};
use std::f64::consts::TAU;
use std::ops::Range;

/// Logarithm of the likelihood of some of the readings, nats; `errors` has one entry a reading, counts.
pub fn likelihood(
    readings: &Readings<'_>,
    filter: &Filter,
    errors: &[f64],
    of: Range<usize>,
) -> f64 {
    of.map(|k| {
        let variance = filter.variances[k];
        let loss = huber(errors[k] * errors[k] / variance);
        -0.5 * readings.weights[k] * (loss + libm::log(TAU * variance))
    })
    .sum()
}

/// The same of each recording.
pub fn likelihoods(readings: &Readings<'_>, filter: &Filter, errors: &[f64]) -> Vec<f64> {
    let recordings = readings.recordings.iter();
    recordings
        .map(|own| likelihood(readings, filter, errors, own.clone()))
        .collect()
}

/// Readings for each independent one: one and twice the sum of the autocorrelation of the standardised innovations, up to where it
/// first turns negative. At least one.
pub fn correlation_length(readings: &Readings<'_>, filter: &Filter, errors: &[f64]) -> f64 {
    let lengths: Vec<f64> = readings
        .recordings
        .iter()
        .filter_map(|own| {
            let moving = own.clone().filter(|&k| readings.weights[k] > 0.5);
            let standardised: Vec<f64> = moving
                .map(|k| (errors[k] / filter.variances[k].sqrt()).clamp(-HUBER, HUBER))
                .collect();
            correlation_time(&standardised)
        })
        .collect();
    let mean = lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
    mean.max(1.0)
}

fn correlation_time(values: &[f64]) -> Option<f64> {
    if values.len() < FEWEST {
        return None;
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n;
    let mut time = 1.0;
    for lag in 1..MOST_LAGS.min(values.len() / 4) {
        let pairs = values[lag..].iter().zip(values);
        let product: f64 = pairs.map(|(a, b)| (a - mean) * (b - mean)).sum();
        let correlation = product / (n - lag as f64) / variance;
        // Also of readings that do not vary at all.
        if correlation.is_nan() || correlation <= 0.0 {
            break;
        }
        time += 2.0 * correlation;
    }
    Some(time)
}
