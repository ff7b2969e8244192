//! What is left when one hypothesis is fitted to another's recording.

use super::hypothesis::{Hypothesis, Setup};
use super::playback::record;
use crate::fit::{self, Options};
use crate::problem::cost::rms_counts;
use crate::problem::{Base, Data, FitProblem, Horizon, StartAngle, Structure};
use crate::solve::levenberg_marquardt::LevenbergMarquardt;
use shared::cost::Cost;
use shared::encoder::FLOOR_RMS_COUNTS;
use shared::error::ModelError;
use shared::excite::Command;
use std::sync::atomic::AtomicBool;

/// Hypotheses are separable where each, fitted to any other's recording, leaves at least this much
/// above the encoder's own error, counts RMS. Less is within the other errors of any model.
pub const SEPARABLE_COUNTS: f64 = 1.0;

/// Relative fall of the sum of squares below which a refit has converged, as in the diagnosis.
const TOLERANCE: f64 = 1e-7;

/// What `fitted` leaves of the recording that it did not make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// Index of the hypothesis that made the recording.
    pub truth: usize,
    /// Index of the hypothesis that was fitted to it.
    pub fitted: usize,
    /// RMS error of the refit above the encoder's own, counts. Infinite before the first refit.
    pub counts: f64,
}

impl Separation {
    /// Every ordered pair that a recording can part: a hypothesis that contains the truth explains all
    /// that the truth does, and is told from it by its needless parameters, not by its error.
    pub fn pairs(hypotheses: &[Hypothesis]) -> Vec<Separation> {
        let indices = 0..hypotheses.len();
        (indices.clone())
            .flat_map(|truth| indices.clone().map(move |fitted| (truth, fitted)))
            .filter(|&(truth, fitted)| !hypotheses[fitted].contains(&hypotheses[truth]))
            .map(|(truth, fitted)| Separation {
                truth,
                fitted,
                counts: f64::INFINITY,
            })
            .collect()
    }
}

/// How hard a refit tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Model evaluations from each start, for each unknown.
    pub evaluations: usize,
    /// Whether it also starts from regression on the recording, beside the hypothesis' own values.
    pub regression: bool,
}

/// What is left, counts RMS above the encoder's own, when `fitted` may choose all its parameters and
/// those of the motor to explain the drive's effect on `truth`. More effort never leaves more.
///
/// # Errors
/// A hypothesis that is no possible model.
pub fn separation(
    truth: &Hypothesis,
    fitted: &Hypothesis,
    setup: &Setup,
    drive: &[Command<f64>],
    effort: Effort,
    stop: &AtomicBool,
) -> Result<f64, ModelError> {
    let data = record(truth, setup, drive)?;
    let options = Options {
        effects: fitted.effects.clone(),
        ..Options::default()
    };
    let own = from_own_values(&data, fitted, &options);
    let mut least = left_after_refit(&own, &options, effort, stop)?;
    if effort.regression
        && let Ok(regressed) = fit::problem(&data, &options)
    {
        least = least.min(left_after_refit(&regressed, &options, effort, stop)?);
    }
    Ok(least)
}

/// The problem of fitting `hypothesis`, begun at its own values. Viscous friction is always free: more
/// freedom than the data may hold makes the refit no worse.
fn from_own_values<'a>(
    data: &'a Data,
    hypothesis: &Hypothesis,
    options: &Options,
) -> FitProblem<'a> {
    let base = Base::Response { damping: true };
    let machine = &hypothesis.machine;
    let structure = Structure::around(data, base, &hypothesis.effects, machine, false);
    let start = structure.coordinates(&structure.values_of(machine, &hypothesis.values, 0.0));
    FitProblem {
        data,
        structure,
        cost: Cost::Squared,
        weight: 1.0,
        horizon: Horizon::Whole,
        start_angle: StartAngle::Free,
        method: options.method,
        start: Some(start),
    }
}

fn left_after_refit(
    problem: &FitProblem<'_>,
    options: &Options,
    effort: Effort,
    stop: &AtomicBool,
) -> Result<f64, ModelError> {
    let solver = LevenbergMarquardt {
        tolerance: TOLERANCE,
        ..LevenbergMarquardt::default()
    };
    let options = Options {
        budget: effort.evaluations * (problem.structure.dim() + 1),
        ..options.clone()
    };
    let found = fit::search(problem, &solver, &options, stop, &mut |_, _| {});
    if !found.cost.is_finite() {
        return Ok(f64::INFINITY);
    }
    let candidate = problem
        .structure
        .candidate(&problem.structure.values(&found.x));
    let rms = rms_counts(problem.data, &problem.errors(&candidate)?);
    Ok((rms * rms - FLOOR_RMS_COUNTS * FLOOR_RMS_COUNTS)
        .max(0.0)
        .sqrt())
}
