//! The model that a diagnosis ends with, fitted to its end: parameters with intervals.

use super::Diagnosis;
use crate::error::Error;
use crate::fit::{self, Fit, Options};
use crate::problem::{Data, FitProblem, Horizon, StartAngle};
use crate::solve::levenberg_marquardt::LevenbergMarquardt;
use crate::solve::{Found, Objective};
use shared::cost::Cost;
use std::sync::atomic::AtomicBool;

/// Evaluations for the end of a fit that stands near its minimum.
const BUDGET: usize = 400;

/// Fits the last model to its end and says what is known of its parameters. A model whose free runs are
/// chaotic stays where it is: its cost has no smooth floor to go down to.
///
/// # Errors
/// Where the model cannot run, which it could before.
pub fn settle(
    diagnosis: &Diagnosis,
    data: &Data,
    held_out: &Data,
    options: &Options,
    stop: &AtomicBool,
) -> Result<Fit, Error> {
    let last = &diagnosis.last;
    let options = Options {
        effects: last.effects.clone(),
        method: last.method,
        budget: BUDGET,
        ..options.clone()
    };
    let start = last.x.clone();
    let problem = FitProblem {
        data,
        structure: last.structure.clone(),
        cost: Cost::Squared,
        weight: 1.0,
        horizon: Horizon::Whole,
        start_angle: StartAngle::Free,
        method: last.method,
        start: Some(start.clone()),
    };
    let found = if last.tracked.is_some() {
        Found {
            cost: problem.cost(&start),
            x: start,
            evaluations: 0,
            curve: Vec::new(),
            interrupted: false,
        }
    } else {
        let solver = LevenbergMarquardt::default();
        fit::search(&problem, &solver, &options, stop, &mut |_, _| {})
    };
    Fit::conclude(&problem, "lm", "squared", &found, &options, Some(held_out))
}
