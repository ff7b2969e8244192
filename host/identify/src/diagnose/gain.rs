//! What an effect more takes away of the error.

use super::models::FittedModel;
use crate::fit::forms::MUST_REMOVE;
use servoid_engine::problem::Data;
use statrs::distribution::{ChiSquared, ContinuousCDF};

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
