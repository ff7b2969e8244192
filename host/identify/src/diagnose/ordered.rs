//! The order in which the effects of a model are told: those first that lower the error most.

use super::context::Context;
use super::models::{FittedModel, same};
use super::screening::restart;
use shared::effects::Kind;

/// The same model with its effects in another order.
pub fn in_order(context: &Context<'_>, model: &FittedModel, order: &[Kind]) -> FittedModel {
    if model.losses.is_some() || model.followed_fraction > 0.0 {
        return model.clone();
    }
    let mut ordered = model.clone();
    ordered.structure.effects.clear();
    ordered.parameters.clear();
    for kind in order {
        let mut rest = &model.parameters[..];
        for own in &model.structure.effects {
            let (values, further) = rest.split_at(own.parameters().len());
            rest = further;
            if own == kind {
                ordered.structure.effects.push(*own);
                ordered.parameters.extend_from_slice(values);
            }
        }
    }
    let start = restart(context, &ordered);
    let values = start.structure.values_of(
        &model.candidate.machine,
        &ordered.parameters,
        model.candidate.start_speed,
    );
    ordered.effects = order.to_vec();
    ordered.structure = start.structure;
    ordered.x = ordered.structure.coordinates(&values);
    ordered.candidate = ordered.structure.candidate(&values);
    ordered.candidate.start_offset = model.candidate.start_offset;
    ordered
}

/// The effects of `chosen` in the order of the fall, as far as `models` of its subsets were fitted: each lowers the error most of those that are
/// left.
pub fn order_of_fall<'m>(
    chosen: &[Kind],
    models: impl Iterator<Item = &'m FittedModel> + Clone,
) -> Vec<Kind> {
    let (mut order, mut left): (Vec<Kind>, Vec<Kind>) = (Vec::new(), chosen.to_vec());
    while left.len() > 1 {
        let error_with = |kind: Kind| {
            let set: Vec<Kind> = order.iter().copied().chain([kind]).collect();
            let own = models.clone().filter(|model| same(&model.effects, &set));
            own.map(|model| model.judged().score())
                .fold(f64::INFINITY, f64::min)
        };
        let errors = left.iter().map(|&kind| (error_with(kind), kind));
        let Some((error, next)) = errors.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            break;
        };
        if error.is_infinite() {
            break;
        }
        order.push(next);
        left.retain(|kind| *kind != next);
    }
    order.extend(left);
    order
}
