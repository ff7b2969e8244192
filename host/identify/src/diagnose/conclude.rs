//! From the levels of a search to what is named: every effect must still hold against others in its place.

use super::levels::Level;
use super::refit::Refit;
use super::workshop::Workshop;
use super::{Diagnosis, Step, judge, missed, moves_both_ways, needless, plainer, spectrum, swap};
use shared::effects::Starts;

/// Swaps earlier terms with their look-alikes, and writes down the steps to the model that was chosen.
pub fn conclude(workshop: &Workshop<'_>, levels: &[Level], diagnosis: &mut Diagnosis) {
    let Some(last) = levels.last() else { return };
    let mut chosen = last.best.clone();
    let mut known = last.models.clone();
    if levels.len() > 1 {
        chosen = needless::spared(workshop, chosen, &mut known);
        for place in chosen.effects.clone() {
            workshop.effort.take_stock();
            let swapped = if chosen.losses.is_some() {
                missed::beside(workshop, &chosen, |workshop, bare| {
                    swap::swaps(workshop, bare, place, &[])
                })
            } else {
                swap::swaps(workshop, &chosen, place, &known)
            };
            if let Some(better) = swap::better(&chosen, &swapped) {
                chosen = better;
            }
            known.extend(swapped);
        }
        chosen = plainer::plainer(workshop, chosen, &mut known);
        chosen = needless::spared(workshop, chosen, &mut known);
    } else {
        chosen = plainer::plainer(workshop, chosen, &mut known);
    }
    let mut base = diagnosis.base.clone();
    // A motor that cannot be tracked keeps the errors of its free run.
    let _ = workshop.track_like(&mut base, &chosen);
    let explained = judge::explained(&base, &chosen);
    let mut before = diagnosis.base.clone();
    for (depth, &added) in chosen.effects.iter().enumerate() {
        let company = judge::company(&chosen, added, &known);
        // A motor that never reverses cannot tell any of them apart: they are named as one.
        let one = workshop.span.window_s.is_some() && !moves_both_ways(workshop.data);
        if !one && !company.allows(added) {
            diagnosis.not_named = Some(added);
            break;
        }
        let prefix = &chosen.effects[..=depth];
        let list = levels
            .get(depth)
            .map(|level| &level.models[..])
            .unwrap_or_default();
        let fitted = |model: &&Refit| swap::same(&model.effects, prefix);
        let after = if depth + 1 == chosen.effects.len() {
            Some(chosen.clone())
        } else {
            let made = list.iter().chain(&known).find(fitted).cloned();
            made.or_else(|| needless::begun(workshop, &chosen, depth + 1))
        };
        let Some(mut after) = after.or(list.first().cloned()) else {
            break;
        };
        workshop.follow_held_out(&mut after);
        let mut candidates = vec![after.clone()];
        candidates.extend(
            list.iter()
                .filter(|m| !swap::same(&m.effects, &after.effects))
                .cloned(),
        );
        let p_values = candidates
            .iter()
            .map(|c| judge::p_value(workshop.data, &before, c))
            .collect();
        diagnosis.steps.push(Step {
            added,
            indistinguishable_from: company.alike.clone(),
            confidence: explained * company.confidence(),
            candidates,
            p_values,
            spectrum: (added.facts().starts == Starts::AngleOrders)
                .then(|| spectrum::spectrum(workshop.data, &before.candidate)),
        });
        before = after.clone();
        diagnosis.last = after;
    }
    diagnosis.rivals = known;
}
