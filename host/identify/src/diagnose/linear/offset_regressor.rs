//! The linear motor by regression with a constant voltage beside it: a strong load or offset hides the motor from a
//! regression without one.

use crate::diagnose::context::Context;
use crate::error::Error;
use crate::fit::{self, Options, scores};
use servoid_engine::problem::rms_counts;
use servoid_engine::problem::{Candidate, Data, FitProblem};
use shared::effects::Kind;
use shared::motor::Machine;

/// The linear motor beside a constant that drives it, with its start.
///
/// # Errors
/// Where regression finds no motor.
pub fn with_offset_regressor<'a>(
    data: &'a Data,
    options: &Options,
) -> Result<FitProblem<'a>, Error> {
    let beside = Options {
        effects: vec![Kind::OffsetVoltage],
        ..options.clone()
    };
    fit::problem(data, &beside)
}

/// The linear motor as regression sees it beside a constant that drives it, and its RMS error over the
/// whole recording, counts. A strong load bends a fit without it by orders of magnitude.
pub fn regressed_beside_offset(
    context: &Context<'_>,
    options: &Options,
) -> Option<(Machine<f64>, f64)> {
    let options = Options {
        window_s: None,
        method: context.method,
        ..options.clone()
    };
    let candidate = candidate_of(&with_offset_regressor(context.data, &options).ok()?);
    let errors = scores::whole(context.data, &candidate, context.method).ok()?;
    Some((candidate.machine, rms_counts(context.data, &errors)))
}

/// The model that a problem starts from.
pub fn candidate_of(problem: &FitProblem<'_>) -> Candidate {
    let start = problem.start.as_deref().unwrap_or_default();
    problem.structure.candidate_at(start)
}
