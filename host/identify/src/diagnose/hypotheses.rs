//! What may be missing, as sets of effects with probabilities: data often allow several, and a single name would hide the
//! others.

use super::models::FittedModel;
use super::naming::Named;
use crate::diagnose::settings::{ABOVE_FLOOR, AT_FLOOR, INDEPENDENT, LEAST};
use shared::effects::Kind;

/// A set of effects that may be what the linear motor lacks.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbableSet {
    /// The effects; none for the linear motor alone.
    pub effects: Vec<Kind>,
    /// Probability that these are what is missing. What all sets leave to one is "none of these".
    pub probability: f64,
    /// Logarithm of its likelihood less the price of its parameters, nats; only differences mean anything. `None` where the set
    /// was not scored.
    pub nats: Option<f64>,
}

/// The sets of effects that were scored: the chosen one, then the others by their probability.
pub fn probable_sets(named: &Named<'_>) -> Vec<ProbableSet> {
    let own = sorted(&named.last.effects);
    let scores = || named.scores.iter();
    let of_own = scores().find(|(effects, _)| sorted(effects) == own);
    let best = scores().map(|(_, nats)| *nats).fold(f64::MIN, f64::max);
    // The chosen set may be simpler than the best and as probable. Where it leaves the encoder's error only, an effect more explains nothing
    // that is there: below a count the arithmetic decides.
    let proven = named.last.is_proven();
    let limit = match of_own {
        Some((_, nats)) if proven => *nats,
        None if proven => f64::INFINITY,
        _ => best,
    };
    let as_good = |effects: &[Kind]| {
        let rivals = named.rivals.iter().filter(|rival| rival.is_proven());
        let mut rivals = rivals.filter(|rival| sorted(&rival.effects) == effects);
        proven.then(|| rivals.next()).flatten()
    };
    let per_parameter = 0.5 * libm::log(INDEPENDENT * named.context.data.counts.len() as f64);
    let weight = |effects: &[Kind], nats: f64| {
        if effects == own {
            1.0
        } else if let Some(rival) = as_good(effects) {
            let more = rival.freedom().saturating_sub(named.last.freedom());
            libm::exp(-per_parameter.max(0.0) * more as f64)
        } else if proven && own.iter().all(|kind| effects.contains(kind)) {
            0.0
        } else {
            libm::exp((nats - limit).min(0.0))
        }
    };
    let mut sets: Vec<ProbableSet> = scores()
        .map(|(effects, nats)| ProbableSet {
            probability: weight(&sorted(effects), *nats),
            effects: effects.clone(),
            nats: Some(*nats),
        })
        .collect();
    if !sets.iter().any(|set| sorted(&set.effects) == own) {
        sets.push(ProbableSet {
            effects: named.last.effects.clone(),
            probability: 1.0,
            nats: None,
        });
    }
    let sum: f64 = sets.iter().map(|set| set.probability).sum();
    let share = if named.floor.is_some_and(|floor| floor.is_reached()) {
        ABOVE_FLOOR / sum
    } else {
        in_catalogue(&named.last, &named.base) / sum
    };
    for set in &mut sets {
        set.probability *= share;
    }
    let is_own = |set: &ProbableSet| sorted(&set.effects) == own;
    sets.retain(|set| is_own(set) || set.probability >= LEAST);
    sets.sort_by(|a, b| (is_own(b).cmp(&is_own(a))).then(b.probability.total_cmp(&a.probability)));
    sets
}

/// Probability that an effect is among what is missing: of all sets with it.
pub fn probability_of(kind: Kind, sets: &[ProbableSet]) -> f64 {
    let with_it = sets.iter().filter(|set| set.effects.contains(&kind));
    with_it.map(|set| set.probability).sum()
}

fn sorted(effects: &[Kind]) -> Vec<Kind> {
    let mut sorted = effects.to_vec();
    sorted.sort_by_key(|kind| kind.name());
    sorted
}

/// Probability that the catalogue holds what is missing. Above the floor it grows with what the model takes away of the
/// linear motor's error, on the recording where it takes away less: the geometric mean of the part of the error itself and of
/// the part of its logarithm down to the floor. (On the bench's other laws the one alone is too sure, the other not enough.)
fn in_catalogue(chosen: &FittedModel, base: &FittedModel) -> f64 {
    if chosen.explains() {
        return AT_FLOOR;
    }
    let (before, after) = (base.ran(), chosen.ran());
    let fitted = taken_away(before.fitted, after.fitted, after.floor);
    let held_out = taken_away(before.held_out, after.held_out, after.floor);
    ABOVE_FLOOR * fitted.min(held_out)
}

/// How much of an error is taken away, from 0 to 1 at the floor.
fn taken_away(before: f64, after: f64, floor: f64) -> f64 {
    let part = 1.0 - after / before;
    let of_the_way = libm::log(before / after) / libm::log(before / floor);
    let both = part.clamp(0.0, 1.0) * of_the_way.clamp(0.0, 1.0);
    // No number where there was no error before.
    if both.is_finite() { both.sqrt() } else { 0.0 }
}
