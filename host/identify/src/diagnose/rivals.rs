//! Effects that explain a recording as well as one of the chosen model does.

use super::models::{FittedModel, same};
use crate::diagnose::settings::MOST_EQUIVALENT;
use shared::effects::Kind;

/// What may stand in the place of one effect of the chosen set.
pub struct Rivals {
    /// Effects that explain this recording as well.
    pub equivalent: Vec<Kind>,
}

impl Rivals {
    /// Those of sets with `scores`, nats, that differ from `chosen` in `place` alone and are within `nats` of it; of the `known` models those that
    /// leave the encoder's error only, where the chosen one does. Below a count the arithmetic decides scores.
    pub fn of(
        chosen: &FittedModel,
        place: Kind,
        scores: &[(Vec<Kind>, f64)],
        nats: f64,
        known: &[FittedModel],
    ) -> Self {
        let effects = &chosen.effects;
        let own = scores.iter().find(|(set, _)| same(set, effects));
        let least = own.map_or(f64::INFINITY, |(_, score)| score - nats);
        let probable = scores.iter().filter(|(_, score)| *score > least);
        let proven = known
            .iter()
            .filter(|model| chosen.is_proven() && model.is_proven());
        let sets = probable.map(|(set, _)| set);
        let sets = sets.chain(proven.map(|model| &model.effects));
        let mut equivalent = Vec::new();
        for kind in sets.filter_map(|set| instead(effects, place, set)) {
            if !equivalent.contains(&kind) {
                equivalent.push(kind);
            }
        }
        Rivals { equivalent }
    }

    /// Whether the effect may be named beside these rivals: not where too many others, or others of quite
    /// another nature, do as well.
    pub fn allows(&self, place: Kind) -> bool {
        let strangers = self
            .equivalent
            .iter()
            .filter(|&&kind| !look_alike(place, kind))
            .count();
        // Laws are tries at one thing, however many there are.
        let (laws, others): (Vec<Kind>, Vec<Kind>) =
            self.equivalent.iter().partition(|&&kind| is_law(kind));
        others.len() + laws.len().min(1) <= MOST_EQUIVALENT && strangers <= 1
    }
}

/// Whether one effect may stand for the other. Laws that are stated or proposed are tries at the same thing: one that holds another as a
/// special case explains all that this does.
fn look_alike(a: Kind, b: Kind) -> bool {
    (is_law(a) && is_law(b)) || a.looks_like(b)
}

fn is_law(kind: Kind) -> bool {
    matches!(kind, Kind::Formula(_))
}

/// The effect that `other` has in the place of `place`, if that is all in which they differ.
fn instead(chosen: &[Kind], place: Kind, other: &[Kind]) -> Option<Kind> {
    if other.len() != chosen.len() || other.contains(&place) {
        return None;
    }
    let mut different = other.iter().filter(|kind| !chosen.contains(kind));
    let instead = *different.next()?;
    different.next().is_none().then_some(instead)
}
