//! A friction with more parameters does whatever a simpler one does, and where runs are chaotic its search finds
//! ways that the simpler one's misses. So each effect of a chosen model is tried once more as the simpler ones
//! that it contains, from where it stands, and must be worth its further parameters.

use super::judge::removes;
use crate::diagnose::candidate::fit::{fit_chaotic, fit_screened};
use crate::diagnose::candidate::observer::observe_like;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::context::Context;
use crate::diagnose::lost_counts;
use crate::diagnose::models::{FittedModel, ScreenedModel, same};
use crate::diagnose::screening::{free_run_error, restart};
use shared::effects::Kind;

/// A simpler model is brought to its end if its score is no further behind than this.
const NEAR: f64 = 3.0;

/// `chosen` with the plainest effects that do as well. Every model that was fitted for it goes to `known`.
pub fn simplify(
    context: &Context<'_>,
    chosen: FittedModel,
    known: &mut Vec<FittedModel>,
) -> FittedModel {
    let mut chosen = chosen;
    loop {
        let tried = all(context, &chosen);
        let plainest = tried
            .iter()
            .filter(|plain| !removes(plain, &chosen))
            .min_by_key(|plain| plain.freedom())
            .cloned();
        // What was fitted from here stands in the place of what was fitted from elsewhere, if it is better.
        for plain in tried {
            let old = (known.iter()).position(|model| same(&model.effects, &plain.effects));
            match old {
                Some(old) if known[old].by_score(&plain).is_gt() => known[old] = plain,
                Some(_) => {}
                None => known.push(plain),
            }
        }
        match plainest {
            Some(plain) => {
                known.push(chosen);
                chosen = plain;
            }
            None => return chosen,
        }
    }
}

/// `chosen` with each simpler effect in the place of one that contains it.
pub fn all(context: &Context<'_>, chosen: &FittedModel) -> Vec<FittedModel> {
    chosen
        .effects
        .iter()
        .flat_map(|&place| Kind::ALL.iter().map(move |&kind| (place, kind)))
        .filter(|(_, kind)| !chosen.effects.contains(kind))
        .flat_map(|(place, kind)| {
            context.budget.checkpoint();
            instead(context, chosen, place, kind)
        })
        .collect()
}

/// `chosen` with `kind` in the place of an effect that contains it.
fn instead(
    context: &Context<'_>,
    chosen: &FittedModel,
    place: Kind,
    kind: Kind,
) -> Vec<FittedModel> {
    if chosen.losses.is_some() && place.containing(kind).is_some() {
        return lost_counts::beside(context, chosen, |context, bare| {
            instead(context, bare, place, kind)
        });
    }
    fitted(context, chosen, place, kind).into_iter().collect()
}

fn fitted(
    context: &Context<'_>,
    chosen: &FittedModel,
    place: Kind,
    kind: Kind,
) -> Option<FittedModel> {
    let general = chosen.values_of(place);
    let values = place.containing(kind)?.values_from(&general)?;
    let mut plain = chosen.without(place);
    plain.effects.push(kind);
    plain.structure.effects.push(kind);
    plain.parameters.extend(values);
    let mut screened = restart(context, &plain);
    screened.simulated = free_run_error(context, &screened, f64::INFINITY);
    // Nothing was screened here: the error that may be hoped for is the chosen one's.
    screened.series_parallel = chosen.ran().fitted;
    fit_simpler(context, chosen, &screened)
}

/// Fits a simpler model than `chosen`, and brings it to its end if it comes near.
pub fn fit_simpler(
    context: &Context<'_>,
    chosen: &FittedModel,
    screened: &ScreenedModel,
) -> Option<FittedModel> {
    // Where free runs are chaotic, they say nothing of a model that was not screened.
    let fit = if chosen.observed.is_some() {
        fit_chaotic
    } else {
        fit_screened
    };
    let mut model = fit(context, screened).ok()?;
    observe_like(context, &mut model, chosen).ok()?;
    let behind = model.judged().score() - chosen.judged().score();
    if !model.judged().at_floor() && behind < NEAR {
        model = polish(context, &model).ok()?;
    }
    Some(model)
}

/// An effect that was beside another one which does all that it can, and is taken away, leaves its size to that one.
pub fn absorb(rest: &mut FittedModel, gone: Kind, values: &[f64]) {
    if !gone
        .parameters()
        .iter()
        .all(|parameter| parameter.amplitude)
    {
        return;
    }
    let mut begin = 0;
    for &kind in &rest.structure.effects {
        let contained = kind.containing(gone).filter(|special| special.whole);
        for (part, size) in contained
            .into_iter()
            .flat_map(|special| special.values.iter().zip(values))
        {
            for place in part.places() {
                if let Some(own) = rest.parameters.get_mut(begin + place) {
                    *own += size;
                }
            }
        }
        begin += kind.parameters().len();
    }
}
