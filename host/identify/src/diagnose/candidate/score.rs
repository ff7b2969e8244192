//! The errors of a model where a search ended, on the fitted and on the held-out recording.

use super::descent::Descent;
use crate::diagnose::context::Workshop;
use crate::diagnose::models::{Errors, Refit, distinct};
use crate::error::Error;
use crate::fit::{scores, validate, validate_roughly};
use servoid_engine::problem::cost::{errors, rms_counts};
use servoid_engine::problem::simulate::Method;
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle, Structure};
use shared::cost::Cost;

/// Scores a model where a search ended.
///
/// # Errors
/// Where the model cannot run.
pub fn score_candidate(
    workshop: &Workshop<'_>,
    structure: Structure,
    found: &Descent,
    foreseen: f64,
    method: Method,
) -> Result<Refit, Error> {
    let values = structure.values(&found.x);
    let candidate = structure.candidate(&values);
    let windows = workshop.span.window_s.is_some();
    Ok(Refit {
        effects: distinct(&structure.effects),
        parameters: structure.effect_values(&values).to_vec(),
        candidate,
        structure,
        x: found.x.clone(),
        losses: None,
        rms_counts: if windows {
            validate_roughly(workshop.data, &candidate, method)?
        } else {
            rms_counts(
                workshop.data,
                &scores::whole(workshop.data, &candidate, method)?,
            )
        },
        windowed: if windows {
            Some(run_errors(workshop, &candidate, method)?)
        } else {
            None
        },
        validate_rms_counts: validate_roughly(workshop.held_out, &candidate, method)?,
        tracked: None,
        tracks: Vec::new(),
        followed: 0.0,
        foreseen_rms_counts: foreseen,
        evaluations: found.evaluations,
        method,
    })
}

/// Errors of a model over the span that was chosen.
///
/// # Errors
/// Where the model cannot run.
pub fn run_errors(
    workshop: &Workshop<'_>,
    candidate: &Candidate,
    method: Method,
) -> Result<Errors, Error> {
    if workshop.span.window_s.is_none() {
        return Ok(Errors {
            fitted: rms_counts(
                workshop.data,
                &scores::whole(workshop.data, candidate, method)?,
            ),
            held_out: validate_roughly(workshop.held_out, candidate, method)?,
            floor: workshop.floor,
        });
    }
    let rms = |data: &Data, horizon: &Horizon| {
        let cost = Cost::Squared;
        errors(data, candidate, method, horizon, StartAngle::Free, cost)
            .map(|errors| rms_counts(data, &errors))
    };
    Ok(Errors {
        fitted: rms(workshop.data, &workshop.fitted_horizon)?,
        held_out: rms(workshop.held_out, &workshop.held_out_horizon)?,
        floor: workshop.floor,
    })
}

/// Looks for the start of the held-out run as it is looked for where results are told.
pub fn refine_held_out_start(workshop: &Workshop<'_>, refit: &mut Refit) {
    // Where nothing depends on the angle, where it began does not matter.
    if refit.losses.is_none()
        && refit.candidate.needs_angle()
        && let Ok(rms) = validate(workshop.held_out, &refit.candidate, refit.method)
    {
        refit.validate_rms_counts = rms;
    }
}
