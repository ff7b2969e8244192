//! Standard errors of a model's parameters from the curvature of its score.

use super::innovations::Innovations;
use super::settings::{KNOWN_PART, RANGE_PRECISION, STEP};
use nalgebra::DMatrix;
use servoid_engine::problem::Structure;
use servoid_engine::solve::Objective;
use std::collections::BTreeMap;

/// Standard errors at the place `x` of the unit cube, each in the parameter's own unit, by its name. What the recordings do not determine, and
/// what stands at an end of its range, has none. `correlation` readings are worth one.
pub fn standard_errors(
    innovations: &Innovations<'_>,
    structure: &Structure,
    x: &[f64],
    correlation: f64,
) -> BTreeMap<String, f64> {
    let free: Vec<usize> = (0..x.len()).filter(|&k| x[k] > 0.0 && x[k] < 1.0).collect();
    let step = |k: usize| if x[k] < 0.5 { STEP } else { -STEP };
    let moved = |k: usize| {
        let mut moved = x.to_vec();
        moved[k] += step(k);
        moved
    };
    let all: Vec<Vec<f64>> = free.iter().map(|&k| moved(k)).collect();
    let changes: Option<Vec<Vec<f64>>> = innovations.changes(x, &all).into_iter().collect();
    let Some(changes) = changes else {
        return BTreeMap::new();
    };
    let product = |i: usize, j: usize| -> f64 {
        let both = changes[i].iter().zip(&changes[j]);
        both.map(|(a, b)| a * b).sum()
    };
    let precision = DMatrix::from_fn(free.len(), free.len(), |i, j| {
        let own = if i == j { RANGE_PRECISION } else { 0.0 };
        product(i, j) / (step(free[i]) * step(free[j]) * correlation) + own
    });
    let Some(covariance) = precision.cholesky().map(|root| root.inverse()) else {
        return BTreeMap::new();
    };
    let known = free.iter().enumerate().filter_map(|(i, &k)| {
        let std = covariance[(i, i)].sqrt();
        let slope = (structure.values(&all[i])[k] - structure.values(x)[k]) / step(k);
        let known = std < KNOWN_PART && slope.is_finite();
        known.then(|| (structure.unknowns[k].name.clone(), (std * slope).abs()))
    });
    known.collect()
}
