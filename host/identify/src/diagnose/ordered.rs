//! A model with its effects in another order, and with the first of them only.

use super::candidate::fit::fit_screened;
use super::context::Context;
use super::models::FittedModel;
use super::screening::restart;
use shared::effects::Kind;

/// The same model with its effects named in another order. What is computed stays as it is: along a chaotic run even the order of a sum
/// decides where it ends.
pub fn in_order(model: &FittedModel, order: &[Kind]) -> FittedModel {
    let mut ordered = model.clone();
    // Lost counts have no place in the structure, and stay last.
    if model.losses.is_none() {
        ordered.effects = order.to_vec();
    }
    ordered
}

/// `chosen` with the first `depth` of its effects only. `None` where it cannot run, or has losses.
pub fn with_first(
    context: &Context<'_>,
    chosen: &FittedModel,
    depth: usize,
) -> Option<FittedModel> {
    if chosen.losses.is_some() {
        return None;
    }
    let drop = |rest: FittedModel, &place: &Kind| rest.without(place);
    let rest = chosen.effects[depth..].iter().fold(chosen.clone(), drop);
    fit_screened(context, &restart(context, &rest)).ok()
}
