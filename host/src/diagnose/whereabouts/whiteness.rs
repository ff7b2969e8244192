//! Whether anything is left in the error of the free run but the encoder's steps: its correlation with itself
//! and with the input (Ljung, *System Identification*, 1999, section 16.6).
//!
//! Samples count only where the reading has moved on, since a motor at rest repeats one error a thousand
//! times. Even so the errors of a counter at steady speed are a sawtooth and no noise, so that textbook limits
//! would be far too narrow: see [`AUTOCORRELATION_LIMIT`].

use crate::problem::Data;

/// Lags, in picked samples, over which the autocorrelation is averaged: a sawtooth is as often against itself
/// as with itself, an error of the model keeps its sign.
const LAGS: usize = 8;
/// Lags at which the correlation with the input is taken.
const INPUT_LAGS: usize = 20;
/// Counts by which the reading must have moved for the next sample to be picked.
const MOVED: f64 = 2.0;
/// Fewest samples for a correlation.
const FEWEST: usize = 100;

/// Largest autocorrelation of an error that is the encoder's alone.
pub const AUTOCORRELATION_LIMIT: f64 = 0.25;
/// Largest correlation with the input of an error that is the encoder's alone, in standard deviations of what
/// independent samples give.
pub const INPUT_LIMIT: f64 = 6.0;

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

/// Correlations of `errors`, model minus reading. `None` where the motor moved too little.
pub fn whiteness(data: &Data, errors: &[f64]) -> Option<Whiteness> {
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
    let correlations: Vec<f64> = (1..=LAGS).map(at).collect();
    let positive = (1..n / 2).map(at).take_while(|r| *r > 0.05);
    let effective_samples = n as f64 / (1.0 + 2.0 * positive.sum::<f64>());
    let scale = (square * input_square).sqrt().max(f64::MIN_POSITIVE);
    let with_input = (0..=INPUT_LAGS).map(|lag| (dot(&input, &error[lag..]) / scale).abs());
    Some(Whiteness {
        samples: n,
        effective_samples,
        autocorrelation: correlations.iter().sum::<f64>() / LAGS as f64,
        input: with_input.fold(0.0, f64::max) * effective_samples.sqrt(),
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
