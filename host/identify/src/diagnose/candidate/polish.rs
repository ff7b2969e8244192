//! Bringing a fit to its end, before what it leaves is blamed on anything but the arithmetic.

use super::both::fit_both;
use super::continuation::follow_by_continuation;
use super::descent::{FINEST, Settings};
use super::observer::observe_like;
use super::score::{refine_held_out_start, run_errors, score_candidate};
use super::search::{fit_problem, search};
use super::settings::{FINER, POLISHED, STEP_ERROR, STEP_PART};
use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use crate::error::Error;
use servoid_engine::problem::{FitProblem, Horizon};
use servoid_engine::simulation::Method;

/// Of one that must converge.
const LAST: Settings = Settings {
    evaluations: 120,
    again: false,
    ..Settings::THOROUGH
};

/// Fits on from where a fit ended, with finer steps as long as they change its error, until it has
/// converged: what is left then is not the arithmetic's.
///
/// # Errors
/// Where the model cannot run, which it could before.
pub fn polish(context: &Context<'_>, model: &FittedModel) -> Result<FittedModel, Error> {
    if model.followed_fraction > 0.0 {
        return Ok(model.clone());
    }
    let mut polished = converge(context, model)?;
    polished.on_both = fit_both(context, &polished);
    if polished.observed.is_none() || polished.is_proven() {
        return Ok(polished);
    }
    // Near enough to the truth even a run over detents, which is chaotic, has a floor to go down to.
    if polished.candidate.needs_angle()
        && let Some(mut followed) = follow_by_continuation(context, &polished)
    {
        observe_like(context, &mut followed, &polished)?;
        refine_held_out_start(context, &mut followed);
        return Ok(followed);
    }
    let free = converge(
        context,
        &FittedModel {
            observed: None,
            ..polished.clone()
        },
    )?;
    Ok(if free.ran().at_floor() {
        FittedModel {
            observed: polished.observed,
            ..free
        }
    } else {
        polished
    })
}

fn converge(context: &Context<'_>, model: &FittedModel) -> Result<FittedModel, Error> {
    let mut best = model.clone();
    loop {
        let method = best.method;
        let problem = FitProblem {
            horizon: match best.observed {
                Some(tracked) => Horizon::Observer(POLISHED * tracked.memory_s),
                None => context.fitted_horizon.clone(),
            },
            ..fit_problem(context, &best.structure, method)
        };
        let Some(found) = search(context, &problem, &best.x, LAST, method) else {
            return Ok(best);
        };
        let polished = score_candidate(
            context,
            best.structure.clone(),
            &found,
            best.predicted_rms_counts,
            method,
        )?;
        let mut polished = FittedModel {
            evaluations: best.evaluations + polished.evaluations,
            chaotic: best.chaotic,
            ..polished
        };
        observe_like(context, &mut polished, &best)?;
        best = polished;
        let finer = Method {
            substeps: method.substeps * FINER,
            ..method
        };
        let (again, ran) = (run_errors(context, &best.candidate, finer)?, best.ran());
        let change = (again.fitted - ran.fitted)
            .abs()
            .max((again.held_out - ran.held_out).abs());
        if best.judged().at_floor()
            || change < STEP_ERROR.max(STEP_PART * (ran.fitted - 1.0))
            || finer.substeps > FINEST
        {
            return Ok(best);
        }
        best.method = finer;
    }
}
