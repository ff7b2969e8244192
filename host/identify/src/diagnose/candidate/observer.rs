//! Errors that are soon forgotten: what models are judged by where their free runs are chaotic.
//!
//! The run is held to the readings, so that an error dies away within some time. The longer that is, the less is missed; but
//! where a shaft slips over detents within it, all models look alike. So models that are compared are held as loosely as the
//! best of them can follow.

use crate::diagnose::context::Context;
use crate::diagnose::models::{Errors, FittedModel, MEMORIES_S, NOISE_COUNTS, ObserverErrors};
use crate::error::Error;
use servoid_engine::problem::cost::{errors, rms_counts};
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle};
use shared::cost::Cost;
use shared::encoder::FLOOR_RMS_COUNTS;

/// A model follows the readings if it errs by no more than this, counts RMS.
const FOLLOWS: f64 = 3.0 * NOISE_COUNTS;

/// Adds the errors that are forgotten within `memory_s`.
///
/// # Errors
/// Where the model cannot run.
fn observe(context: &Context<'_>, refit: &mut FittedModel, memory_s: f64) -> Result<(), Error> {
    if let Some(known) = refit
        .observed_runs
        .iter()
        .find(|known| known.memory_s == memory_s)
    {
        refit.observed = Some(*known);
        return Ok(());
    }
    let tracked = |data: &Data| {
        errors(
            data,
            &Candidate {
                start_speed: 0.0,
                start_offset: 0.0,
                ..refit.candidate
            },
            refit.method,
            &Horizon::Nudged(memory_s),
            StartAngle::Free,
            Cost::Squared,
        )
        .map(|errors| rms_counts(data, &errors))
    };
    let errors = Errors {
        fitted: tracked(context.data)?,
        held_out: tracked(context.held_out)?,
        floor: FLOOR_RMS_COUNTS,
    };
    let tracked = ObserverErrors { errors, memory_s };
    refit.observed = Some(tracked);
    refit.observed_runs.push(tracked);
    Ok(())
}

/// Tracks a model as another one is, which it is to be compared with; not at all if that is not.
///
/// # Errors
/// Where the model cannot run.
pub fn observe_like(
    context: &Context<'_>,
    refit: &mut FittedModel,
    other: &FittedModel,
) -> Result<(), Error> {
    match (refit.observed, other.observed) {
        (_, None) => Ok(()),
        (Some(own), Some(other)) if own.memory_s == other.memory_s => Ok(()),
        (_, Some(other)) => observe(context, refit, other.memory_s),
    }
}

/// Tracks all of some models in the same way.
pub fn observe_all(context: &Context<'_>, refits: &mut [FittedModel]) {
    for memory_s in MEMORIES_S {
        for refit in refits.iter_mut() {
            if refit.observed.is_none_or(|own| own.memory_s != memory_s) {
                // A model that cannot be tracked keeps the errors of its free runs.
                let _ = observe(context, refit, memory_s);
            }
        }
        let errors = refits.iter().filter_map(|refit| refit.observed);
        if errors.into_iter().any(|t| t.errors.fitted < FOLLOWS) {
            break;
        }
    }
}
