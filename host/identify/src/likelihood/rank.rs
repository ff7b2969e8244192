//! Sets of terms by their BIC.

use super::maximum::{Maximum, Settings, fit};
use super::observed::Observed;
use super::terms::Terms;
use std::sync::atomic::AtomicBool;

/// A set of terms, and its fit where there is one.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The terms.
    pub terms: Terms,
    /// Their most likely model.
    pub maximum: Option<Maximum>,
}

impl Ranked {
    /// The BIC; smaller is better. `None` where there is no fit.
    pub fn bic(&self) -> Option<f64> {
        self.maximum.as_ref().map(|m| m.bic)
    }
}

/// Fits each set of terms to the same readings, so that their BICs can be compared; in the given order.
///
/// BIC tends to add small terms that are only partly real: ask also for a size that matters and for some standard errors.
pub fn rank(
    recordings: &[&Observed],
    sets: &[Terms],
    settings: &Settings,
    stop: &AtomicBool,
) -> Vec<Ranked> {
    (sets.iter())
        .map(|&terms| Ranked {
            terms,
            maximum: fit(recordings, terms, settings, stop),
        })
        .collect()
}
