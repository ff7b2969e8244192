//! A friction with more parameters does whatever a plainer one does, and where runs are chaotic its search finds
//! ways that the plainer one's misses. So each effect of a chosen model is tried once more as the plainer ones
//! that it contains, from where it stands, and must be worth its further parameters.

use super::judge::removes;
use super::missed;
use super::refit::Refit;
use super::swap::{same, without};
use super::workshop::Workshop;
use shared::effects::Kind;

/// A plainer model is brought to its end if its score is no further behind than this.
const NEAR: f64 = 3.0;

/// `chosen` with the plainest effects that do as well. Every model that was fitted for it goes to `known`.
pub fn plainer(workshop: &Workshop<'_>, chosen: Refit, known: &mut Vec<Refit>) -> Refit {
    let mut chosen = chosen;
    loop {
        let tried = all(workshop, &chosen);
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
pub fn all(workshop: &Workshop<'_>, chosen: &Refit) -> Vec<Refit> {
    chosen
        .effects
        .iter()
        .flat_map(|&place| Kind::ALL.iter().map(move |&kind| (place, kind)))
        .filter(|(_, kind)| !chosen.effects.contains(kind))
        .flat_map(|(place, kind)| {
            workshop.effort.take_stock();
            instead(workshop, chosen, place, kind)
        })
        .collect()
}

/// `chosen` with `kind` in the place of an effect that contains it.
fn instead(workshop: &Workshop<'_>, chosen: &Refit, place: Kind, kind: Kind) -> Vec<Refit> {
    if chosen.losses.is_some() && place.containing(kind).is_some() {
        return missed::beside(workshop, chosen, |workshop, bare| {
            instead(workshop, bare, place, kind)
        });
    }
    fitted(workshop, chosen, place, kind).into_iter().collect()
}

fn fitted(workshop: &Workshop<'_>, chosen: &Refit, place: Kind, kind: Kind) -> Option<Refit> {
    let general = super::evidence::values(chosen, place);
    let values = place.containing(kind)?.values_from(&general)?;
    let mut plain = without(chosen, place);
    plain.effects.push(kind);
    plain.structure.effects.push(kind);
    plain.parameters.extend(values);
    let mut sketch = workshop.restarted(&plain);
    sketch.simulated = workshop.leaves(&sketch, f64::INFINITY);
    // Nothing was led here: the error that may be hoped for is the chosen one's.
    sketch.led = chosen.ran().fitted;
    let mut refit = workshop.refit(&sketch).ok()?;
    workshop.track_like(&mut refit, chosen).ok()?;
    let behind = refit.judged().score() - chosen.judged().score();
    if !refit.judged().at_floor() && behind < NEAR {
        refit = workshop.polish(&refit).ok()?;
    }
    Some(refit)
}

/// An effect that was beside another one which does all that it can, and is taken away, leaves its size to that one.
pub fn absorb(rest: &mut Refit, gone: Kind, values: &[f64]) {
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
