//! Which model may be believed, and beside which others.

use crate::diagnose::models::{FittedModel, same};
use crate::fit::forms::MUST_REMOVE;
use servoid_engine::problem::Data;
use shared::effects::Kind;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Errors within this factor of the floor leave nothing to explain: five standard deviations of what a recording
/// of some thousand readings has.
const EXACT: f64 = 1.02;
/// Models whose score is within this of the best explain the recording alike.
const EQUIVALENT: f64 = 0.1;
/// Of models within this of the best score the simplest is taken: 2 % in each error.
const AS_GOOD: f64 = 0.04;
/// More models than this that explain a recording alike, and none of them is named.
const MOST_EQUIVALENT: usize = 4;

/// The best of some models that are sorted by score: the simplest of those that are as good as the first, and of equally simple ones
/// that with fewest laws, as effects of the catalogue come first.
pub fn best(models: &[FittedModel]) -> Option<&FittedModel> {
    let least = models.first()?.judged().score();
    let best = models
        .iter()
        .take_while(|model| model.judged().score() - least < AS_GOOD)
        .min_by_key(|model| {
            let laws = model.effects.iter().filter(|kind| is_law(**kind));
            (model.freedom(), laws.count())
        })?;
    Some(models.iter().fold(
        best,
        |best, model| {
            if replaces(model, best) { model } else { best }
        },
    ))
}

/// Whether a simpler model will do in the place of another that has a look-alike of one of its effects. Where errors
/// are above the reading's own, any further parameter lowers them a little: the other must remove as much of the
/// simpler one's excess as a further effect would have to.
pub fn replaces(simpler: &FittedModel, other: &FittedModel) -> bool {
    simpler.freedom() < other.freedom()
        && differ_by_look_alike(simpler, other)
        && !removes(simpler, other)
}

/// Whether one effect may stand for the other. Laws that are stated or proposed are tries at the same thing: one that holds another as a
/// special case explains all that this does.
fn look_alike(a: Kind, b: Kind) -> bool {
    (is_law(a) && is_law(b)) || a.looks_like(b)
}

fn is_law(kind: Kind) -> bool {
    matches!(kind, Kind::Formula(_))
}

/// Whether two models differ in one effect only, and there by look-alikes.
fn differ_by_look_alike(a: &FittedModel, b: &FittedModel) -> bool {
    let mut own = a.effects.iter().filter(|kind| !b.effects.contains(kind));
    match (own.next(), own.next()) {
        (Some(&place), None) => {
            instead(&a.effects, place, &b.effects).is_some_and(|kind| look_alike(place, kind))
        }
        _ => false,
    }
}

/// Whether a model leaves nothing that bristles could explain, `floor` being what the reading's own noise makes of a right one.
pub fn is_exact(model: &FittedModel, floor: f64) -> bool {
    let ran = model.ran();
    ran.at_floor() && ran.fitted.max(ran.held_out) < EXACT * floor
}

/// Whether `after` removes enough of what `before` leaves, on the held-out recording above all.
pub fn removes(before: &FittedModel, after: &FittedModel) -> bool {
    // Both in the same measure: a free run is no rival of one that is held to the reading.
    let (old, new) = match (before.observed, after.observed) {
        _ if before.is_proven() => return false,
        (Some(old), Some(_)) if old.errors.at_floor() && !old.is_loose() => return false,
        (Some(old), Some(new)) => (old.errors, new.errors),
        _ => (before.ran(), after.ran()),
    };
    let removed = 1.0 - new.excess() / old.excess();
    removed > MUST_REMOVE && new.fitted < old.fitted
}

/// What stands beside the chosen model.
pub struct Rivals {
    /// Effects that explain this recording as well in the place of the one in question.
    pub equivalent: Vec<Kind>,
}

/// Looks for models that differ from `chosen` in `place` alone, among `others`.
pub fn rivals(chosen: &FittedModel, place: Kind, others: &[FittedModel]) -> Rivals {
    let mut rivals = Rivals {
        equivalent: Vec::new(),
    };
    for other in others {
        let Some(instead) = instead(&chosen.effects, place, &other.effects) else {
            continue;
        };
        let behind = other.judged().score() - chosen.judged().score();
        if behind < EQUIVALENT && !rivals.equivalent.contains(&instead) {
            rivals.equivalent.push(instead);
        }
    }
    rivals
}

/// The same of sets with `scores`, nats: those within `nats` of the chosen one are as probable.
pub fn rivals_by_score(
    chosen: &[Kind],
    place: Kind,
    scores: &[(Vec<Kind>, f64)],
    nats: f64,
) -> Rivals {
    let own = scores.iter().find(|(set, _)| same(set, chosen));
    let least = own.map_or(f64::INFINITY, |(_, score)| score - nats);
    let probable = scores.iter().filter(|(_, score)| *score > least);
    Rivals {
        equivalent: probable
            .filter_map(|(set, _)| instead(chosen, place, set))
            .collect(),
    }
}

impl Rivals {
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

/// The effect that `other` has in the place of `place`, if that is all in which they differ.
fn instead(chosen: &[Kind], place: Kind, other: &[Kind]) -> Option<Kind> {
    if other.len() != chosen.len() || other.contains(&place) {
        return None;
    }
    let mut different = other.iter().filter(|kind| !chosen.contains(kind));
    let instead = *different.next()?;
    different.next().is_none().then_some(instead)
}

/// Chance of so large a fall of the error if the new effect were absent: likelihood ratio with as many
/// samples as the reading changes, since a motor at rest says the same thing a thousand times.
pub fn p_value(data: &Data, before: &FittedModel, after: &FittedModel) -> f64 {
    let samples = data.transitions() as f64;
    let statistic = 2.0 * samples * libm::log(before.ran().fitted / after.ran().fitted);
    let searched = |model: &FittedModel| model.structure.dim() - model.structure.held();
    let added = searched(after).saturating_sub(searched(before)).max(1);
    let law = ChiSquared::new(added as f64).ok();
    let law = law.filter(|_| statistic.is_finite());
    law.map_or(1.0, |law| law.sf(statistic.max(0.0)))
}
