//! Leaving out what later effects made needless: the first effect of several is chosen while the others are
//! missing, and may have stood in for them.

use super::judge::removes;
use super::missed;
use super::plainer;
use super::refit::Refit;
use super::swap::without;
use super::workshop::Workshop;
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
            .filter(|&&place| !place.facts().by_chance)
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
        return missed::beside(workshop, chosen, |workshop, bare| {
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
    let drop = |rest: Refit, &place: &Kind| without(&rest, place);
    let rest = chosen.effects[depth..].iter().fold(chosen.clone(), drop);
    workshop.refit(&workshop.restarted(&rest)).ok()
}

fn fitted_without(workshop: &Workshop<'_>, chosen: &Refit, place: Kind) -> Option<Refit> {
    let mut rest = without(chosen, place);
    plainer::absorb(&mut rest, place, &super::evidence::values(chosen, place));
    let mut sketch = workshop.restarted(&rest);
    sketch.simulated = workshop.leaves(&sketch, f64::INFINITY);
    if !sketch.rivals(chosen) {
        sketch = workshop.sketch_from(&sketch.structure, sketch.x)?;
    }
    if !sketch.rivals(chosen) {
        return None;
    }
    let mut refit = workshop.refit(&sketch).ok()?;
    workshop.track_like(&mut refit, chosen).ok()?;
    let behind = refit.judged().score() - chosen.judged().score();
    if !refit.judged().at_floor() && behind < NEAR {
        refit = workshop.polish(&refit).ok()?;
    }
    Some(refit)
}
