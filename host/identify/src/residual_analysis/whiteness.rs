//! Whether anything is left in the error of the free run but the encoder's steps: its correlation with itself
//! and with the input (Ljung, *System Identification*, 1999, section 16.6).
//!
//! Samples count only where the reading has moved on, since a motor at rest repeats one error a thousand
//! times. Even so the errors of a counter at steady speed are a sawtooth and no noise, so that textbook limits
//! would be far too narrow: see [`AUTOCORRELATION_LIMIT`].

use crate::fit::correlation_sum;
use servoid_engine::problem::Data;

/// Lags, in picked samples, over which the autocorrelation is averaged: a sawtooth is as often against itself
/// as with itself, an error of the model keeps its sign.
const LAGS: usize = 8;
/// Lags that are drawn.
const DRAWN_LAGS: usize = 40;
/// Lags at which the correlation with the input is taken.
const INPUT_LAGS: usize = 20;
/// Counts by which the reading must have moved for the next sample to be picked.
const MOVED: f64 = 2.0;
/// Fewest samples for a correlation.
const FEWEST: usize = 100;

/// Mean autocorrelation up to which an error may be the encoder's alone.
///
/// The linear motor fitted to 96 recordings of four seconds from the bench's motors with nothing hidden (steps,
/// telegraph, staircase, reversals, triangle, chirp; 500 to 8000 counts) left a median of -0.003, 0.06 at 90 %,
/// and 0.41 at most, at steady speeds of nearly whole counts a sample. With friction, cogging, drag or brushes
/// hidden it was above 0.98, with a delay of 2 ms 0.73.
pub const AUTOCORRELATION_LIMIT: f64 = 0.5;
/// Correlation with the input up to which an error may be the encoder's alone, in standard deviations of what
/// independent samples give. In the same recordings the largest of 21 lags had a median of 0.23, 0.86 at 90 %, and
/// 2.96 at most: below what noise would give, since a fit leaves nothing that is correlated with its input.
pub const INPUT_LIMIT: f64 = 4.0;

/// Correlations of an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whiteness {
    /// Samples that were picked.
    pub samples: usize,
    /// How many of them count as independent.
    pub effective_samples: f64,
    /// Mean of the autocorrelation at lags of 1 to 8 picked samples.
    pub autocorrelation: f64,
    /// Largest correlation with the command, by size, at lags of 0 to 20 picked samples, times the root of the
    /// effective samples.
    pub input: f64,
}

impl Whiteness {
    /// Whether nothing is left but the encoder's steps.
    pub fn is_white(&self) -> bool {
        self.autocorrelation <= AUTOCORRELATION_LIMIT && self.input <= INPUT_LIMIT
    }
}

/// An error's correlations with itself and with the command, lag by lag, for a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlations {
    /// Samples that were picked.
    pub samples: usize,
    /// How many of them count as independent.
    pub effective_samples: f64,
    /// With itself, from lag 0 on.
    pub own: Vec<f64>,
    /// With the command, which is ahead of the error by -20 to 20 picked samples.
    pub input: Vec<f64>,
}

/// Correlations of `errors`, model minus reading. `None` where the motor moved too little.
pub fn correlations(data: &Data, errors: &[f64]) -> Option<Correlations> {
    let picked = picked(data);
    let n = picked.len();
    if n < FEWEST {
        return None;
    }
    let centred = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / n as f64;
        let values: Vec<f64> = values.iter().map(|x| x - mean).collect();
        let square: f64 = values.iter().map(|x| x * x).sum();
        (values, square)
    };
    let (error, square) = centred(picked.iter().map(|&k| errors[k]).collect());
    let (input, input_square) = centred(picked.iter().map(|&k| data.command[k]).collect());
    if square <= 0.0 {
        return None;
    }
    let at = |lag: usize| dot(&error, &error[lag..]) / square;
    let remembered = correlation_sum(n / 2, at);
    let scale = (square * input_square).sqrt().max(f64::MIN_POSITIVE);
    let behind = (1..=INPUT_LAGS).rev().map(|lag| dot(&input[lag..], &error));
    let ahead = (0..=INPUT_LAGS).map(|lag| dot(&input, &error[lag..]));
    Some(Correlations {
        samples: n,
        effective_samples: n as f64 / (1.0 + 2.0 * remembered),
        own: (0..=DRAWN_LAGS).map(at).collect(),
        input: behind.chain(ahead).map(|sum| sum / scale).collect(),
    })
}

/// What the correlations of `errors` come to. `None` where the motor moved too little.
pub fn whiteness(data: &Data, errors: &[f64]) -> Option<Whiteness> {
    let found = correlations(data, errors)?;
    let ahead = found.input[INPUT_LAGS..].iter();
    let largest = ahead.fold(0.0, |most: f64, r| most.max(r.abs()));
    Some(Whiteness {
        samples: found.samples,
        effective_samples: found.effective_samples,
        autocorrelation: found.own[1..=LAGS].iter().sum::<f64>() / LAGS as f64,
        input: largest * found.effective_samples.sqrt(),
    })
}

/// Samples at which the reading has moved on from the one picked before.
fn picked(data: &Data) -> Vec<usize> {
    let mut picked: Vec<usize> = Vec::new();
    for k in 0..data.len() {
        let far = |&last: &usize| (data.counts[k] - data.counts[last]).abs() >= MOVED;
        if picked.last().is_none_or(far) {
            picked.push(k);
        }
    }
    picked
}

/// Over the length of the shorter one.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests;
