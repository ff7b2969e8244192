//! A search that ended early looks like missing physics. So near winners are each begun once more from where
//! the other one stands, before one of them is believed.

use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::observer::observe_like;
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, ScreenedModel};
use crate::diagnose::screening::{EffectValues, with_common_parameters};
use rayon::prelude::*;

/// A rival whose score is so far behind the best is begun once more.
const NEAR: f64 = 1.2;
/// One that gained more than this by it is taken.
const GAINED: f64 = 0.01;
/// Rivals that are begun once more.
const RIVALS: usize = 2;

/// Lets the look-alikes among the first of some models, sorted by score, start from each other's machine and
/// common parameters, and sorts again.
pub fn cross_start(context: &Context<'_>, models: &mut [FittedModel]) {
    let Some(best) = models.first().cloned() else {
        return;
    };
    let near = |model: &FittedModel| model.judged().score() - best.judged().score() < NEAR;
    let alike = |model: &FittedModel| match (model.effects.split_last(), best.effects.split_last())
    {
        (Some((&own, rest)), Some((&other, others))) => rest == others && own.looks_like(other),
        _ => false,
    };
    let places: Vec<usize> = (1..models.len())
        .filter(|&i| near(&models[i]) && alike(&models[i]))
        .take(RIVALS)
        .collect();
    let Some(&first) = places.first() else {
        return;
    };
    let mut pairs: Vec<(usize, usize)> = places.iter().map(|&i| (i, 0)).collect();
    if !best.judged().at_floor() {
        pairs.push((0, first));
    }
    let again: Vec<(usize, FittedModel)> = pairs
        .par_iter()
        .filter_map(|&(own, other)| {
            let fitted = from_there(context, &models[own], &models[other])?;
            let gained = models[own].judged().score() - fitted.judged().score();
            (gained > GAINED).then_some((own, fitted))
        })
        .collect();
    for (place, fitted) in again {
        models[place] = fitted;
    }
    models.sort_by(FittedModel::by_score);
}

fn found(fitted: &FittedModel) -> EffectValues<'_> {
    EffectValues {
        effects: &fitted.structure.effects,
        values: &fitted.parameters,
    }
}

/// `model`, fitted again from the machine of `other` and those parameters that both know.
fn from_there(
    context: &Context<'_>,
    model: &FittedModel,
    other: &FittedModel,
) -> Option<FittedModel> {
    let parameters = with_common_parameters(found(model), found(other));
    let start = ScreenedModel::standing(model.structure.clone(), &other.candidate, &parameters);
    let mut fitted = fit_screened(context, &start).ok()?;
    fitted.predicted_rms_counts = model.predicted_rms_counts;
    observe_like(context, &mut fitted, model).ok()?;
    fitted.evaluations += model.evaluations;
    Some(fitted)
}
