//! Residual of one hypothesis fitted to another's recording.

use super::hypothesis::{Hypothesis, Setup};
use super::playback::record;
use crate::fit::{self, Options};
use servoid_engine::problem::rms_counts;
use servoid_engine::problem::{Base, Data, FitProblem, Horizon, StartAngle, Structure};
use servoid_engine::solve::Objective;
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
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

/// Evaluations beside those of the steps: the start, and trial points that were refused.
const SPARE: usize = 2;

/// Separation of the ordered pair `truth`, `fitted`.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// Index of the hypothesis that made the recording.
    pub truth: usize,
    /// Index of the hypothesis that was fitted to it.
    pub fitted: usize,
    /// RMS error of the refit above the encoder's own, counts. Infinite before the first refit, and an
    /// upper bound after it: the search is local, from a few starts.
    pub counts: f64,
    /// The fitted hypothesis with the values that imitate the truth best so far.
    pub imitation: Hypothesis,
}

impl Separation {
    /// Every ordered pair that a recording can separate: a hypothesis that contains the truth explains all
    /// that the truth does; its surplus parameters rule it out, not its error.
    pub fn pairs(hypotheses: &[Hypothesis]) -> Vec<Separation> {
        let pair = |truth: usize, fitted: usize| Separation {
            truth,
            fitted,
            counts: f64::INFINITY,
            imitation: hypotheses[fitted].clone(),
        };
        let indices = 0..hypotheses.len();
        (indices.clone())
            .flat_map(|truth| indices.clone().map(move |fitted| (truth, fitted)))
            .filter(|&(truth, fitted)| !hypotheses[fitted].contains(&hypotheses[truth]))
            .map(|(truth, fitted)| pair(truth, fitted))
            .collect()
    }
}

/// Budget of a refit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefitBudget {
    /// Steps of the search, each with its own Jacobian.
    pub steps: usize,
    /// Steps of a second search, which starts from regression on the recording; 0 for none.
    pub regression: usize,
}

/// A drive and the hypotheses for its recording.
pub struct Trial<'a> {
    /// The hypotheses.
    pub hypotheses: &'a [Hypothesis],
    /// Drive, encoder and motor.
    pub setup: &'a Setup,
    /// The drive.
    pub drive: &'a [Command<f64>],
    /// Ends a search early.
    pub stop: &'a AtomicBool,
}

impl Trial<'_> {
    /// The separation after a refit of all parameters, the motor's among them, to the recording that the
    /// drive makes of the truth. It begins at the hypothesis' own values or at its imitation, whichever
    /// is nearer.
    ///
    /// # Errors
    /// A hypothesis that is no possible model.
    pub fn refit(&self, pair: &Separation, budget: RefitBudget) -> Result<Separation, ModelError> {
        let (truth, own) = (&self.hypotheses[pair.truth], &self.hypotheses[pair.fitted]);
        let data = record(truth, self.setup, self.drive)?;
        let options = Options {
            effects: own.effects.clone(),
            ..Options::default()
        };
        let mut problem = problem(&data, own, &options);
        if pair.imitation != *own {
            let values = values_of(&problem.structure, &pair.imitation);
            let near = problem.structure.coordinates(&values);
            let nearer = |own: &Vec<f64>| problem.cost(&near) < problem.cost(own);
            if problem.start.as_ref().is_none_or(nearer) {
                problem.start = Some(near);
            }
        }
        let mut best = self.search(&problem, &options, budget.steps, pair)?;
        if budget.regression > 0
            && let Ok(regressed) = fit::problem(&data, &options)
        {
            let other = self.search(&regressed, &options, budget.regression, pair)?;
            if other.counts < best.counts {
                best = other;
            }
        }
        Ok(best)
    }

    fn search(
        &self,
        problem: &FitProblem<'_>,
        options: &Options,
        steps: usize,
        pair: &Separation,
    ) -> Result<Separation, ModelError> {
        let solver = LevenbergMarquardt {
            tolerance: TOLERANCE,
        };
        let options = Options {
            budget: steps * (problem.structure.dim() + 1) + SPARE,
            ..options.clone()
        };
        let found = fit::search(problem, &solver, &options, self.stop, &mut |_, _| {});
        if !found.cost.is_finite() {
            return Ok(pair.clone());
        }
        let candidate = problem.structure.candidate_at(&found.x);
        let rms = rms_counts(problem.data, &problem.errors(&candidate)?);
        let floor = FLOOR_RMS_COUNTS;
        Ok(Separation {
            counts: (rms * rms - floor * floor).max(0.0).sqrt(),
            imitation: Hypothesis::of(&candidate),
            ..*pair
        })
    }
}

/// The problem of fitting `hypothesis`, begun at its own values. Viscous friction is always free: more
/// freedom than the data may hold makes the refit no worse.
fn problem<'a>(data: &'a Data, hypothesis: &Hypothesis, options: &Options) -> FitProblem<'a> {
    let base = Base::Response { damping: true };
    let machine = &hypothesis.machine;
    let mut structure = Structure::around(data, base, &hypothesis.effects, machine, false);
    let values = values_of(&structure, hypothesis);
    structure.free_forms_in(&values);
    let start = structure.coordinates(&values);
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

fn values_of(structure: &Structure, hypothesis: &Hypothesis) -> Vec<f64> {
    structure.values_of(&hypothesis.machine, &hypothesis.values, 0.0)
}
