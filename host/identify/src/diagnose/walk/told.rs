//! What a score tells of one model: its standard errors, and the floor below its error in windows.

use super::evidence::Evidence;
use super::floor::floor;
use super::settings::NOISE_ROUNDS;
use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use crate::diagnose::outcome::Floor;
use std::collections::BTreeMap;

/// Standard errors of the model's unknowns by name, and the floor; nothing where whole runs are judged. `base` is the linear motor.
pub fn told(
    context: &Context<'_>,
    base: &FittedModel,
    model: &FittedModel,
) -> Option<(BTreeMap<String, f64>, Floor)> {
    let window_s = context.span.window_s?;
    let mut evidence = Evidence::new(context, base);
    for _ in 0..NOISE_ROUNDS {
        evidence.estimate_noise(&model.candidate);
    }
    evidence.estimate_correlation(&model.candidate);
    let floor = floor(&evidence, model, window_s);
    Some((evidence.standard_errors(model), floor))
}
