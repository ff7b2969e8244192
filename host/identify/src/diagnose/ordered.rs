//! A model with its effects in another order, and with the first of them only.

use super::candidate::fit::fit_screened;
use super::context::Context;
use super::models::FittedModel;
use super::screening::restart;
use shared::effects::Kind;

/// The same model with its effects in another order.
pub fn in_order(context: &Context<'_>, model: &FittedModel, order: &[Kind]) -> FittedModel {
    if model.effects == order || model.losses.is_some() || model.followed_fraction > 0.0 {
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
    let mut start = restart(context, &ordered);
    // A range that was widened stays.
    for unknown in &mut start.structure.unknowns {
        let mut own = model.structure.unknowns.iter();
        if let Some(own) = own.find(|own| own.name == unknown.name) {
            unknown.range = own.range;
        }
    }
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
