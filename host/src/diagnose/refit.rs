//! One model with one set of effects, fitted to the recording and judged on the other.

use super::NOISE_COUNTS;
use crate::error::Error;
use crate::fit::{self, Options, scores, validate};
use crate::problem::cost::rms_counts;
use crate::problem::{Candidate, Data, FitProblem};
use crate::solve::Objective;
use crate::solve::levenberg_marquardt::LevenbergMarquardt;
use shared::effects::Kind;
use std::sync::atomic::AtomicBool;

/// Evaluations of one refit at most.
const BUDGET: usize = 400;
/// Relative fall of the sum of squares below which a refit has converged.
const TOLERANCE: f64 = 1e-7;

/// A fitted model with its errors.
#[derive(Clone, Debug)]
pub struct Refit {
    /// The effects, the newest last.
    pub effects: Vec<Kind>,
    /// The model.
    pub candidate: Candidate,
    /// Values of the effects' parameters, SI.
    pub parameters: Vec<f64>,
    /// RMS error on the fitted recording, open loop, counts.
    pub rms_counts: f64,
    /// RMS error on the held-out recording, counts.
    pub validate_rms_counts: f64,
}

impl Refit {
    /// Whether both errors are the encoder's own.
    pub fn at_floor(&self) -> bool {
        self.rms_counts < NOISE_COUNTS && self.validate_rms_counts < NOISE_COUNTS
    }

    /// ln(fitted · held-out error), neither counted below the noise: what candidates are ranked by.
    pub fn score(&self) -> f64 {
        let floored = |rms: f64| rms.max(shared::encoder::FLOOR_RMS_COUNTS);
        (floored(self.rms_counts) * floored(self.validate_rms_counts)).ln()
    }
}

/// Fits the linear motor with `effects`, from regression and from the model that it extends.
///
/// # Errors
/// [`Error::Failed`] where no motor fits even roughly.
pub fn refit(
    data: &Data,
    held_out: &Data,
    effects: &[Kind],
    extends: Option<&Refit>,
    options: &Options,
    stop: &AtomicBool,
) -> Result<Refit, Error> {
    let options = Options {
        effects: effects.to_vec(),
        budget: BUDGET,
        ..options.clone()
    };
    let mut problem = fit::problem(data, &options)?;
    let mut best: Option<(f64, Vec<f64>)> = None;
    for start in starts(&problem, extends) {
        problem.start = Some(start);
        let solver = LevenbergMarquardt {
            tolerance: TOLERANCE,
            ..LevenbergMarquardt::default()
        };
        let found = fit::search(&problem, &solver, &options, stop, &mut |_, _| {});
        if best.as_ref().is_none_or(|(cost, _)| found.cost < *cost) {
            best = Some((found.cost, found.x));
        }
    }
    let (_, x) =
        best.ok_or_else(|| Error::Failed(format!("{}: no start for a fit", data.source)))?;
    let values = problem.structure.values(&x);
    let candidate = problem.structure.candidate(&values);
    let whole = scores::whole(data, &candidate, options.method)?;
    let parameters = candidate
        .effects
        .iter()
        .flat_map(|(_, values)| values.to_vec())
        .collect();
    Ok(Refit {
        effects: effects.to_vec(),
        candidate,
        parameters,
        rms_counts: rms_counts(data, &whole),
        validate_rms_counts: validate(held_out, &candidate, options.method)?,
    })
}

/// Starts of the search: the regression's, and that of the extended model with the regression's
/// values for the new effect. Only one where both cost about the same.
fn starts(problem: &FitProblem<'_>, extends: Option<&Refit>) -> Vec<Vec<f64>> {
    let Some(regression) = problem.start.clone() else {
        return Vec::new();
    };
    let Some(base) = extends else {
        return vec![regression];
    };
    let guessed = problem.structure.values(&regression);
    let guessed = problem.structure.candidate(&guessed);
    let mut effects = base.parameters.clone();
    let new: Vec<f64> = guessed
        .effects
        .iter()
        .flat_map(|(_, values)| values.to_vec())
        .collect();
    effects.extend_from_slice(&new[effects.len().min(new.len())..]);
    let values = problem.structure.values_of(
        &base.candidate.machine,
        &effects,
        base.candidate.start_speed,
    );
    let extended = problem.structure.coordinates(&values);
    let (a, b) = (problem.cost(&regression), problem.cost(&extended));
    // A start ten times worse than the other is not worth a search of its own.
    match (a, b) {
        _ if a > 100.0 * b => vec![extended],
        _ if b > 100.0 * a => vec![regression],
        _ => vec![regression, extended],
    }
}
