//! One effect that a diagnosis names.

use crate::diagnose::models::FittedModel;
use crate::diagnose::spectrum::Spectrum;
use shared::effects::Kind;

/// One effect that was added, and what it was chosen from.
#[derive(Clone, Debug)]
pub struct Step {
    /// The effect.
    pub added: Kind,
    /// Effects that explain this recording as well.
    pub indistinguishable_from: Vec<Kind>,
    /// Probability that the effect is among what is missing: of all the diagnosis' sets with it.
    pub confidence: f64,
    /// All candidates with their refits, best first.
    pub candidates: Vec<FittedModel>,
    /// Chance of so large a gain if the effect were absent, for each candidate.
    pub p_values: Vec<f64>,
    /// All orders of a cogging torque, of which the model holds the strongest.
    pub spectrum: Option<Spectrum>,
}
