//! A model along other recordings of its motor.

use crate::diagnose::candidate::descent::Descent;
use crate::diagnose::candidate::score::score_candidate;
use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use crate::diagnose::screening::restart;

/// A model along the recordings of a context, where it stands.
pub fn along(context: &Context<'_>, model: &FittedModel) -> Option<FittedModel> {
    let start = restart(context, model);
    let found = Descent {
        x: start.x,
        squares: 0.0,
        evaluations: model.evaluations,
    };
    let predicted = model.predicted_rms_counts;
    let along = score_candidate(context, start.structure, &found, predicted, model.method).ok()?;
    Some(FittedModel {
        standard_errors: model.standard_errors.clone(),
        ..along
    })
}
