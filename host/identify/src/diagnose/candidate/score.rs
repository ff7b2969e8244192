//! The errors of a model where a search ended, on the fitted and on the held-out recording.

use super::descent::Descent;
use crate::diagnose::context::Context;
use crate::diagnose::models::{Errors, FittedModel, distinct};
use crate::error::Error;
use crate::fit::{scores, validate, validate_roughly};
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle, Structure};
use servoid_engine::problem::{errors, rms_counts};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use std::collections::BTreeMap;

/// Scores a model where a search ended.
///
/// # Errors
/// Where the model cannot run.
pub fn score_candidate(
    context: &Context<'_>,
    structure: Structure,
    found: &Descent,
    predicted: f64,
    method: Method,
) -> Result<FittedModel, Error> {
    let values = structure.values(&found.x);
    let candidate = structure.candidate(&values);
    let windows = context.span.window_s.is_some();
    Ok(FittedModel {
        effects: distinct(&structure.effects),
        parameters: structure.effect_values(&values).to_vec(),
        candidate,
        structure,
        x: found.x.clone(),
        losses: None,
        rms_counts: if windows {
            validate_roughly(context.data, &candidate, method)?
        } else {
            rms_counts(
                context.data,
                &scores::whole(context.data, &candidate, method)?,
            )
        },
        windowed: if windows {
            Some(run_errors(context, &candidate, method)?)
        } else {
            None
        },
        validate_rms_counts: validate_roughly(context.held_out, &candidate, method)?,
        chaotic: false,
        observed: None,
        observed_runs: Vec::new(),
        followed_fraction: 0.0,
        on_both: None,
        predicted_rms_counts: predicted,
        evaluations: found.evaluations,
        method,
        standard_errors: BTreeMap::new(),
    })
}

/// Errors of a model over the span that was chosen.
///
/// # Errors
/// Where the model cannot run.
pub fn run_errors(
    context: &Context<'_>,
    candidate: &Candidate,
    method: Method,
) -> Result<Errors, Error> {
    if context.span.window_s.is_none() {
        return Ok(Errors {
            fitted: rms_counts(
                context.data,
                &scores::whole(context.data, candidate, method)?,
            ),
            held_out: validate_roughly(context.held_out, candidate, method)?,
            floor: context.floor,
        });
    }
    let rms = |data: &Data, horizon: &Horizon| {
        let cost = Cost::Squared;
        errors(data, candidate, method, horizon, StartAngle::Free, cost)
            .map(|errors| context.rms_over(data, horizon, &errors))
    };
    Ok(Errors {
        fitted: rms(context.data, &context.fitted_horizon)?,
        held_out: rms(context.held_out, &context.held_out_horizon)?,
        floor: context.floor,
    })
}

/// Looks for the start of the held-out run as it is looked for where results are told.
pub fn refine_held_out_start(context: &Context<'_>, model: &mut FittedModel) {
    // Where nothing depends on the angle, where it began does not matter.
    if model.losses.is_none()
        && model.candidate.needs_angle()
        && let Ok(rms) = validate(context.held_out, &model.candidate, model.method)
    {
        model.validate_rms_counts = rms;
    }
}
