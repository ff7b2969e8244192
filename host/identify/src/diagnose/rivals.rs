//! What stands beside the chosen model.

use super::models::same;
use shared::effects::Kind;

/// More models than this that explain a recording alike, and none of them is named.
const MOST_EQUIVALENT: usize = 4;

/// What may stand in the place of one effect of the chosen set.
pub struct Rivals {
    /// Effects that explain this recording as well.
    pub equivalent: Vec<Kind>,
}

impl Rivals {
    /// Those of sets with `scores`, nats, that differ from `chosen` in `place` alone and are within `nats` of it.
    pub fn of(chosen: &[Kind], place: Kind, scores: &[(Vec<Kind>, f64)], nats: f64) -> Self {
        let own = scores.iter().find(|(set, _)| same(set, chosen));
        let least = own.map_or(f64::INFINITY, |(_, score)| score - nats);
        let probable = scores.iter().filter(|(_, score)| *score > least);
        Rivals {
            equivalent: probable
                .filter_map(|(set, _)| instead(chosen, place, set))
                .collect(),
        }
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
