//! Leaving out what later effects made needless: the first effect of several is chosen while the others are
//! missing, and may have stood in for them.

use super::judge::removes;
use super::nested_models;
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::observer::observe_like;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::context::Workshop;
use crate::diagnose::lost_counts;
use crate::diagnose::models::Refit;
use crate::diagnose::screening::{free_run_error, restart, screen_from};
use shared::effects::Kind;

/// A model with one effect less is brought to its end if its score is no further behind than this.
const NEAR: f64 = 3.0;

/// `chosen` without the effects that no longer earn their place beside the others. Every model that was fitted
/// for it goes to `known`.
pub fn spared(workshop: &Workshop<'_>, chosen: Refit, known: &mut Vec<Refit>) -> Refit {
    let mut chosen = chosen;
    while chosen.effects.len() > 1 {
        let simpler = chosen
            .effects
            .iter()
            .filter(|&&place| place != Kind::MissedCounts)
            .flat_map(|&place| {
                workshop.effort.take_stock();
                lessened(workshop, &chosen, place)
            })
            .inspect(|model| known.push(model.clone()))
            .filter(|simpler| !removes(simpler, &chosen))
            .min_by(Refit::by_score);
        match simpler {
            Some(simpler) => chosen = simpler,
            None => break,
        }
    }
    chosen
}

/// `chosen` without one of its effects.
fn lessened(workshop: &Workshop<'_>, chosen: &Refit, place: Kind) -> Vec<Refit> {
    if chosen.losses.is_some() {
        return lost_counts::beside(workshop, chosen, |workshop, bare| {
            lessened(workshop, bare, place)
        });
    }
    fitted_without(workshop, chosen, place)
        .into_iter()
        .collect()
}

/// `chosen` with the first `depth` of its effects only. `None` where it cannot run, or has losses.
pub fn begun(workshop: &Workshop<'_>, chosen: &Refit, depth: usize) -> Option<Refit> {
    if chosen.losses.is_some() {
        return None;
    }
    let drop = |rest: Refit, &place: &Kind| rest.without(place);
    let rest = chosen.effects[depth..].iter().fold(chosen.clone(), drop);
    fit_screened(workshop, &restart(workshop, &rest)).ok()
}

fn fitted_without(workshop: &Workshop<'_>, chosen: &Refit, place: Kind) -> Option<Refit> {
    let mut rest = chosen.without(place);
    nested_models::absorb(&mut rest, place, &chosen.values_of(place));
    let mut sketch = restart(workshop, &rest);
    sketch.simulated = free_run_error(workshop, &sketch, f64::INFINITY);
    if !sketch.rivals(chosen) {
        sketch = screen_from(workshop, &sketch.structure, sketch.x)?;
    }
    if !sketch.rivals(chosen) {
        return None;
    }
    let mut refit = fit_screened(workshop, &sketch).ok()?;
    observe_like(workshop, &mut refit, chosen).ok()?;
    let behind = refit.judged().score() - chosen.judged().score();
    if !refit.judged().at_floor() && behind < NEAR {
        refit = polish(workshop, &refit).ok()?;
    }
    Some(refit)
}
