//! Errors that are soon forgotten: what models are judged by where their free runs are chaotic.
//!
//! The run is held to the readings, so that an error dies away within some time. The longer that is, the less is missed; but
//! where a shaft slips over detents within it, all models look alike. So models that are compared are held as loosely as the
//! best of them can follow.

use super::settings::{FOLLOWS, OBSERVER_SETTLED};
use crate::diagnose::context::Context;
use crate::diagnose::models::{Errors, FittedModel, MEMORIES_S, ObserverErrors};
use crate::error::Error;
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle};
use servoid_engine::problem::{errors, rms_counts};
use shared::cost::Cost;
use shared::encoder::FLOOR_RMS_COUNTS;

/// Adds the errors that are forgotten within `memory_s`.
///
/// # Errors
/// Where the model cannot run.
fn observe(context: &Context<'_>, model: &mut FittedModel, memory_s: f64) -> Result<(), Error> {
    if let Some(known) = model
        .observed_runs
        .iter()
        .find(|known| known.memory_s == memory_s)
    {
        model.observed = Some(*known);
        return Ok(());
    }
    let observed = |data: &Data| {
        errors(
            data,
            &Candidate {
                start_speed: data.start_speed(0),
                start_offset: 0.0,
                ..model.candidate
            },
            model.method,
            &Horizon::Observer(memory_s),
            StartAngle::Free,
            Cost::Squared,
        )
        .map(|errors| rms_counts(data, &errors[settled_at(data, memory_s)..]))
    };
    let errors = Errors {
        fitted: observed(context.data)?,
        held_out: observed(context.held_out)?,
        floor: FLOOR_RMS_COUNTS,
    };
    let observed = ObserverErrors { errors, memory_s };
    model.observed = Some(observed);
    model.observed_runs.push(observed);
    Ok(())
}

/// The first sample at which the error of a start in motion is forgotten: a few readings tell its speed only roughly.
fn settled_at(data: &Data, memory_s: f64) -> usize {
    let Some(&start) = data.time_s.first().filter(|_| data.may_start_moving(0)) else {
        return 0;
    };
    let settled = (data.time_s).partition_point(|t| t - start < OBSERVER_SETTLED * memory_s);
    // A recording that is no longer than that is judged as it is.
    if settled < data.len() / 2 { settled } else { 0 }
}

/// Observes a model as another one is, which it is to be compared with; not at all if that is not.
///
/// # Errors
/// Where the model cannot run.
pub fn observe_like(
    context: &Context<'_>,
    model: &mut FittedModel,
    other: &FittedModel,
) -> Result<(), Error> {
    match (model.observed, other.observed) {
        (_, None) => Ok(()),
        (Some(own), Some(other)) if own.memory_s == other.memory_s => Ok(()),
        (_, Some(other)) => observe(context, model, other.memory_s),
    }
}

/// Observes all of some models in the same way.
pub fn observe_all(context: &Context<'_>, models: &mut [FittedModel]) {
    for memory_s in MEMORIES_S {
        for model in models.iter_mut() {
            if model.observed.is_none_or(|own| own.memory_s != memory_s) {
                // A model that no observer can hold to the readings keeps the errors of its free runs.
                let _ = observe(context, model, memory_s);
            }
        }
        let errors = models.iter().filter_map(|model| model.observed);
        if errors.into_iter().any(|t| t.errors.fitted < FOLLOWS) {
            break;
        }
    }
}
