//! The linear motor, fitted.

use super::offset_regressor::{candidate_of, with_offset_regressor};
use crate::diagnose::candidate::descent::{Descent, Settings};
use crate::diagnose::candidate::score::score_candidate;
use crate::diagnose::candidate::search::{fit_problem, search};
use crate::diagnose::context::{Context, floor_counts};
use crate::diagnose::models::FittedModel;
use crate::error::Error;
use crate::fit::{self, Options, base_for};
use servoid_engine::problem::{FitProblem, Structure};

/// Of the linear motor.
const BASE: Settings = Settings {
    tolerance: 1e-6,
    ..Settings::THOROUGH
};

/// The linear motor, and the context with the floor that its time constant makes of the reading's noise.
///
/// # Errors
/// [`Error::Failed`] where no motor fits even roughly.
pub fn fit_linear<'a>(
    mut context: Context<'a>,
    options: &Options,
) -> Result<(Context<'a>, FittedModel), Error> {
    let options = Options {
        effects: Vec::new(),
        window_s: context.span.window_s,
        method: context.method,
        ..options.clone()
    };
    let problem = started_problem(&context, &options)?;
    let start = problem.start.clone().unwrap_or_default();
    let found = search(&context, &problem, &start, BASE, context.method)
        .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", context.data.source)))?;
    let structure = problem.structure;
    let mut base = scored(&context, structure, &found)?;
    let machine = &base.candidate.machine;
    let fitted = floor_counts(context.data, &context.fitted_horizon, machine);
    let held_out = floor_counts(context.held_out, &context.held_out_horizon, machine);
    context.floor = fitted.max(held_out);
    if let Some(windowed) = &mut base.windowed {
        windowed.floor = context.floor;
    }
    Ok((context, base))
}

fn scored(
    context: &Context<'_>,
    structure: Structure,
    found: &Descent,
) -> Result<FittedModel, Error> {
    let predicted = (found.squares / context.samples() as f64).sqrt();
    score_candidate(context, structure, found, predicted, context.method)
}

/// The linear motor with a start. A strong offset hides the motor from regression: then it is found beside
/// one.
fn started_problem<'a>(
    context: &'a Context<'_>,
    options: &Options,
) -> Result<FitProblem<'a>, Error> {
    let plain = fit::problem(context.data, options);
    let Err(error) = plain else { return plain };
    let Ok(with_offset) = with_offset_regressor(context.data, options) else {
        return Err(error);
    };
    let candidate = candidate_of(&with_offset);
    let speed = with_offset.structure.start_speed;
    let structure = Structure::around(
        context.data,
        base_for(context.data, &[], context.span.window_s.is_some()),
        &[],
        &candidate.machine,
        speed,
    );
    let mut problem = fit_problem(context, &structure, context.method);
    let values = structure.values_of(&candidate.machine, &[], candidate.start_speed);
    problem.start = Some(structure.coordinates(&values));
    Ok(problem)
}
