//! Trying earlier terms against their look-alikes: what was named first was judged without the rest.

use super::judge::{best, is_exact};
use super::refit::Refit;
use super::workshop::Workshop;
use rayon::prelude::*;
use shared::effects::Kind;

/// Models in which `place` is replaced by one of its look-alikes, refitted from where `chosen` stands,
/// except those that are in `known` already.
pub fn swaps(workshop: &Workshop<'_>, chosen: &Refit, place: Kind, known: &[Refit]) -> Vec<Refit> {
    place
        .description()
        .look_alikes
        .par_iter()
        .filter_map(|name| Kind::by_name(name))
        .filter(|&kind| !kind.facts().by_chance)
        .filter_map(|kind| swapped(workshop, chosen, place, kind, known))
        .collect()
}

/// The model in which `place` is replaced by `kind`; `None` where it is no rival, or known.
pub fn swapped(
    workshop: &Workshop<'_>,
    chosen: &Refit,
    place: Kind,
    kind: Kind,
    known: &[Refit],
) -> Option<Refit> {
    if !chosen.effects.contains(&place) || chosen.effects.contains(&kind) {
        return None;
    }
    if kind.facts().costly && is_exact(chosen, workshop.floor) {
        return None;
    }
    let without = without(chosen, place);
    let mut set = without.effects.clone();
    set.push(kind);
    if known.iter().any(|model| same(&model.effects, &set)) {
        return None;
    }
    let first = kind.facts().starts.after();
    let first = first.and_then(|plainer| workshop.sketch(&without, plainer, &[]));
    let sketch = workshop.sketch(&without, kind, first.as_slice())?;
    if !sketch.rivals(chosen) {
        return None;
    }
    let mut refit = workshop.refit(&sketch).ok()?;
    workshop.track_like(&mut refit, chosen).ok()?;
    Some(refit)
}

/// Whether two lists hold the same effects.
pub fn same(a: &[Kind], b: &[Kind]) -> bool {
    a.len() == b.len() && a.iter().all(|kind| b.contains(kind))
}

/// The model with the parameters that it has, less one effect.
pub fn without(chosen: &Refit, place: Kind) -> Refit {
    let mut rest = &chosen.parameters[..];
    let mut refit = chosen.clone();
    refit.effects.clear();
    refit.parameters.clear();
    refit.structure.effects.clear();
    for &kind in &chosen.structure.effects {
        let (own, further) = rest.split_at(kind.description().parameters.len());
        rest = further;
        if kind != place {
            if !refit.effects.contains(&kind) {
                refit.effects.push(kind);
            }
            refit.structure.effects.push(kind);
            refit.parameters.extend_from_slice(own);
        }
    }
    refit
}

/// The best of `chosen` and `others`.
pub fn better(chosen: &Refit, others: &[Refit]) -> Option<Refit> {
    let mut all: Vec<Refit> = others.to_vec();
    all.push(chosen.clone());
    all.sort_by(Refit::by_score);
    best(&all)
        .filter(|model| !same(&model.effects, &chosen.effects))
        .cloned()
}
