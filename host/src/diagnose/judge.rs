//! Which candidate, if any, may be named.

use super::{Refit, Step};
use crate::problem::Data;
use shared::effects::Kind;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Part of the held-out excess over the encoder's floor that a named effect must remove.
const MUST_REMOVE: f64 = 0.6;
/// Lead over the best rival that is no look-alike, in the logarithm of the errors' product.
const MUST_LEAD: f64 = 0.1;
/// Candidates whose score is within this of the best explain the recording alike.
const ALIKE: f64 = 0.1;

/// What the judge says.
pub enum Ruling {
    /// An effect is named.
    Named(Step),
    /// None is; perhaps one was near.
    Doubtful(Option<Kind>),
}

/// Judges the refitted candidates against the model that they extend.
pub fn judge(data: &Data, before: &Refit, mut candidates: Vec<Refit>) -> Ruling {
    candidates.sort_by(|a, b| a.score().total_cmp(&b.score()));
    let Some(best) = candidates.first() else {
        return Ruling::Doubtful(None);
    };
    let Some(&added) = best.effects.last() else {
        return Ruling::Doubtful(None);
    };
    let removed = 1.0 - excess(best.validate_rms_counts) / excess(before.validate_rms_counts);
    if removed.is_nan() || removed < MUST_REMOVE {
        return Ruling::Doubtful((removed > 0.0).then_some(added));
    }
    let newest = |refit: &Refit| refit.effects.last().copied();
    // Known look-alikes, and whatever explains this recording as well, are no rivals: they are
    // named beside the winner.
    let look_alike = |kind: Kind| added.description().look_alikes.contains(&kind.name());
    let alike: Vec<Kind> = candidates[1..]
        .iter()
        .filter(|rival| rival.score() - best.score() < ALIKE)
        .filter_map(newest)
        .collect();
    let lead = candidates[1..]
        .iter()
        .filter(|rival| newest(rival).is_some_and(|kind| !look_alike(kind)))
        .map(|rival| rival.score() - best.score())
        .fold(f64::INFINITY, f64::min);
    if lead < MUST_LEAD && alike.iter().any(|&kind| !look_alike(kind)) {
        return Ruling::Doubtful(Some(added));
    }
    let p_values = candidates
        .iter()
        .map(|refit| p_value(data, before, refit))
        .collect();
    Ruling::Named(Step {
        added,
        indistinguishable_from: alike,
        confidence: 1.0 / (1.0 + (-lead / MUST_LEAD).exp()),
        candidates,
        p_values,
    })
}

/// Mean square error beyond the encoder's own.
fn excess(rms: f64) -> f64 {
    (rms * rms - 1.0 / 12.0).max(0.0)
}

/// Chance of so large a fall of the error if the new effect were absent: likelihood ratio with as many
/// samples as the reading changes, since a motor at rest says the same thing a thousand times.
fn p_value(data: &Data, before: &Refit, after: &Refit) -> f64 {
    let samples = data.transitions() as f64;
    let statistic = 2.0 * samples * (before.rms_counts / after.rms_counts).ln();
    let added = after
        .parameters
        .len()
        .saturating_sub(before.parameters.len())
        .max(1);
    ChiSquared::new(added as f64).map_or(1.0, |law| law.sf(statistic.max(0.0)))
}
