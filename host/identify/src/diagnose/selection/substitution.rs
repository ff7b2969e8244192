//! Trying earlier terms against their look-alikes: what was named first was judged without the rest.

use super::judge::{best, is_exact};
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::observer::observe_like;
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, same};
use crate::diagnose::screening::screen;
use rayon::prelude::*;
use shared::effects::formula::Output;
use shared::effects::{Kind, Place};

/// Models in which `place` is replaced by one of its look-alikes, refitted from where `chosen` stands,
/// except those that are in `known` already. A law may look like any effect of the catalogue that acts where it does: what the catalogue
/// states is no law.
pub fn substitutes(
    context: &Context<'_>,
    chosen: &FittedModel,
    place: Kind,
    known: &[FittedModel],
) -> Vec<FittedModel> {
    let look_alikes: Vec<Kind> = match place {
        Kind::Formula(law) => {
            let places = places(law.program.output);
            let all = Kind::ALL.iter().copied();
            all.filter(|kind| places.contains(&kind.description().place))
                .collect()
        }
        _ => {
            let names = place.description().look_alikes.iter();
            names.filter_map(|name| Kind::by_name(name)).collect()
        }
    };
    look_alikes
        .into_par_iter()
        .filter(|&kind| !kind.facts().by_chance)
        .filter_map(|kind| substituted(context, chosen, place, kind, known))
        .collect()
}

/// Where effects of the catalogue act that a law may be like.
fn places(output: Output) -> &'static [Place] {
    match output {
        Output::Torque | Output::Friction | Output::TorqueConstant | Output::Inertia => {
            &[Place::Torque, Place::Friction, Place::Winding]
        }
        Output::Voltage => &[Place::Drive, Place::Winding],
        Output::Angle => &[Place::Sensed],
    }
}

/// The model in which `place` is replaced by `kind`; `None` where it is no rival, or known.
pub fn substituted(
    context: &Context<'_>,
    chosen: &FittedModel,
    place: Kind,
    kind: Kind,
    known: &[FittedModel],
) -> Option<FittedModel> {
    if !chosen.effects.contains(&place) || chosen.effects.contains(&kind) {
        return None;
    }
    if kind.facts().costly && is_exact(chosen, context.floor) {
        return None;
    }
    let without = chosen.without(place);
    let mut set = without.effects.clone();
    set.push(kind);
    if known.iter().any(|model| same(&model.effects, &set)) {
        return None;
    }
    let first = kind.facts().starts.after();
    let first = first.and_then(|simpler| screen(context, &without, simpler, &[]));
    let screened = screen(context, &without, kind, first.as_slice())?;
    if !screened.may_rival(chosen) {
        return None;
    }
    let mut model = fit_screened(context, &screened).ok()?;
    observe_like(context, &mut model, chosen).ok()?;
    Some(model)
}

/// The best of `chosen` and `others`.
pub fn better(chosen: &FittedModel, others: &[FittedModel]) -> Option<FittedModel> {
    let mut all: Vec<FittedModel> = others.to_vec();
    all.push(chosen.clone());
    all.sort_by(FittedModel::by_score);
    best(&all)
        .filter(|model| !same(&model.effects, &chosen.effects))
        .cloned()
}
