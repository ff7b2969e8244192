//! A friction with more parameters does whatever a plainer one does, and where runs are chaotic its search finds
//! ways that the plainer one's misses. So each effect of a chosen model is tried once more as the plainer ones
//! that it contains, from where it stands, and must be worth its further parameters.

use super::judge::removes;
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::observer::observe_like;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::context::Context;
use crate::diagnose::lost_counts;
use crate::diagnose::models::{FittedModel, same};
use crate::diagnose::screening::{free_run_error, restart};
use shared::effects::Kind;

/// A plainer model is brought to its end if its score is no further behind than this.
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
            .min_by_key(|plain| plain.parameters.len())
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

/// `chosen` with each plainer effect in the place of one that contains it.
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
    if chosen.losses.is_some() && special_values(place, kind, &[1.0; 8]).is_some() {
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
    let values = special_values(place, kind, &chosen.values_of(place))?;
    let mut plain = chosen.without(place);
    plain.effects.push(kind);
    plain.structure.effects.push(kind);
    plain.parameters.extend(values);
    let mut screened = restart(context, &plain);
    screened.simulated = free_run_error(context, &screened, f64::INFINITY);
    // Nothing was screened here: the error that may be hoped for is the chosen one's.
    screened.series_parallel = chosen.ran().fitted;
    let mut model = fit_screened(context, &screened).ok()?;
    observe_like(context, &mut model, chosen).ok()?;
    let behind = model.judged().score() - chosen.judged().score();
    if !model.judged().at_floor() && behind < NEAR {
        model = polish(context, &model).ok()?;
    }
    Some(model)
}

/// Values for the parameters of `special` at which it comes nearest to `general` with these `values`; `None` where
/// the one does not contain the other.
fn special_values(general: Kind, special: Kind, values: &[f64]) -> Option<Vec<f64>> {
    match (general, special, values) {
        (Kind::Stribeck | Kind::Lugre, Kind::Coulomb, &[torque, ..]) => Some(vec![torque]),
        // Bristles that hardly bend.
        (Kind::Lugre, Kind::Stribeck, &[torque, excess, speed, ..]) => {
            Some(vec![torque, excess * torque, speed, 2.0])
        }
        (Kind::AsymCoulomb, Kind::Coulomb, &[forward, backward, ..]) => {
            Some(vec![0.5 * (forward + backward)])
        }
        // A gap that is closed.
        (Kind::Backlash, Kind::Compliance, &[_, share, period, damping, ..]) => {
            Some(vec![period, share, damping])
        }
        _ => None,
    }
}

/// Friction that was beside another one which contains it, and is taken away, leaves its torque to that one.
pub fn absorb(rest: &mut FittedModel, gone: Kind, values: &[f64]) {
    let (Kind::Coulomb, &[torque, ..]) = (gone, values) else {
        return;
    };
    let mut place = 0;
    for &kind in &rest.structure.effects {
        let torques = match kind {
            Kind::Stribeck | Kind::Lugre => 1,
            Kind::AsymCoulomb => 2,
            _ => 0,
        };
        for own in rest.parameters.iter_mut().skip(place).take(torques) {
            *own += torque;
        }
        place += kind.description().parameters.len();
    }
}
