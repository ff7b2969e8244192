//! Leaving out what later effects made needless: the first effect of several is chosen while the others are
//! missing, and may have stood in for them.

use super::judge::removes;
use super::nested_models;
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::context::Context;
use crate::diagnose::lost_counts;
use crate::diagnose::models::FittedModel;
use crate::diagnose::screening::{free_run_error, restart, screen_from};
use shared::effects::Kind;

/// `chosen` without the effects that no longer earn their place beside the others. Every model that was fitted
/// for it goes to `known`.
pub fn eliminate(
    context: &Context<'_>,
    chosen: FittedModel,
    known: &mut Vec<FittedModel>,
) -> FittedModel {
    let mut chosen = chosen;
    while chosen.effects.len() > 1 {
        let simpler = chosen
            .effects
            .iter()
            .filter(|&&place| !place.facts().by_chance)
            .flat_map(|&place| {
                context.budget.checkpoint();
                without_one(context, &chosen, place)
            })
            .inspect(|model| known.push(model.clone()))
            .filter(|simpler| !removes(simpler, &chosen))
            .min_by(FittedModel::by_score);
        match simpler {
            Some(simpler) => chosen = simpler,
            None => break,
        }
    }
    chosen
}

/// The best model that is left of `chosen` without `place`. `None` where none comes near it.
pub fn left(context: &Context<'_>, chosen: &FittedModel, place: Kind) -> Option<FittedModel> {
    let rest = without_one(context, chosen, place).into_iter();
    rest.min_by(FittedModel::by_score)
}

/// `chosen` without one of its effects.
fn without_one(context: &Context<'_>, chosen: &FittedModel, place: Kind) -> Vec<FittedModel> {
    if chosen.losses.is_some() {
        return lost_counts::beside(context, chosen, |context, bare| {
            without_one(context, bare, place)
        });
    }
    fitted_without(context, chosen, place).into_iter().collect()
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

fn fitted_without(context: &Context<'_>, chosen: &FittedModel, place: Kind) -> Option<FittedModel> {
    let mut rest = chosen.without(place);
    nested_models::absorb(&mut rest, place, &chosen.values_of(place));
    let mut screened = restart(context, &rest);
    screened.simulated = free_run_error(context, &screened, f64::INFINITY);
    if !screened.may_rival(chosen) {
        screened = screen_from(context, &screened.structure, screened.x)?;
    }
    if !screened.may_rival(chosen) {
        return None;
    }
    nested_models::fit_simpler(context, chosen, &screened)
}
