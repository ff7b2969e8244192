//! The most likely model: scoring (Gauss–Newton steps on the likelihood) with Levenberg's damping.
//!
//! Source: L. Ljung, *System Identification*, 2nd ed., 1999, §10.2 (damped Gauss–Newton search on prediction errors).

use super::objective::{Evaluated, Objective};
use super::parameters::{Coordinate, Scale};
use super::slopes::{Differences, slopes};
use nalgebra::DMatrix;
use std::sync::atomic::{AtomicBool, Ordering};

/// Longest step of one coordinate, units.
const LONGEST: f64 = 8.0;
/// Dampings that are tried from one point.
const TRIALS: usize = 8;
/// Fall of the cost, part of it, below which the search ends.
const WORTHWHILE: f64 = 1e-8;
/// The same as a number: less than this part of a standard error is left.
const LEFT: f64 = 1e-3;

/// How far to go.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    pub(super) iterations: usize,
    pub(super) differences: Differences,
}

/// Descends from `start`; the flag says whether it has converged.
pub(super) fn descend(
    objective: &Objective<'_>,
    start: Evaluated,
    coordinates: &[(Coordinate, Scale)],
    effort: Effort,
    stop: &AtomicBool,
) -> (Evaluated, bool) {
    let mut here = start;
    let mut damping = 1e-2;
    for _ in 0..effort.iterations {
        if stop.load(Ordering::Relaxed) {
            return (here, false);
        }
        let Some(slopes) = slopes(objective, &here, coordinates, effort.differences) else {
            return (here, false);
        };
        let mut gradient = slopes.gradient.clone();
        let mut information = slopes.information.clone();
        // What stands at its bound and would leave it is held: the others' steps do not count on it.
        for (i, (c, scale)) in coordinates.iter().enumerate() {
            if gradient[i] > 0.0 && scale.at_least(*c, &here.parameters) {
                gradient[i] = 0.0;
                information.row_mut(i).fill(0.0);
                information.column_mut(i).fill(0.0);
                information[(i, i)] = 1.0;
            }
        }
        let better = (0..TRIALS).find_map(|_| {
            let mut matrix = information.clone();
            for i in 0..coordinates.len() {
                matrix[(i, i)] += damping * matrix[(i, i)] + 1e-9;
            }
            let found = step(&matrix, &gradient)
                .map(|step| moved(objective, &here, coordinates, step.as_slice()))
                .filter(|next| next.posterior < here.posterior);
            if found.is_none() {
                damping = (damping * 6.0).max(1e-3);
            }
            found
        });
        let Some(next) = better else {
            // No damping helps: as low as differences can tell.
            return (here, true);
        };
        let fall = here.posterior - next.posterior;
        here = next;
        damping = (damping * 0.2).max(1e-6);
        if fall < LEFT.max(WORTHWHILE * here.posterior.abs()) {
            return (here, true);
        }
    }
    (here, false)
}

fn step(
    matrix: &DMatrix<f64>,
    gradient: &nalgebra::DVector<f64>,
) -> Option<nalgebra::DVector<f64>> {
    let step = -matrix.clone().cholesky()?.solve(gradient);
    step.iter().all(|x| x.is_finite()).then_some(step)
}

fn moved(
    objective: &Objective<'_>,
    here: &Evaluated,
    coordinates: &[(Coordinate, Scale)],
    step: &[f64],
) -> Evaluated {
    let mut p = here.parameters.clone();
    for ((c, scale), units) in coordinates.iter().zip(step) {
        scale.moved(*c, &mut p, units.clamp(-LONGEST, LONGEST));
    }
    objective.at(p, Some(here))
}
