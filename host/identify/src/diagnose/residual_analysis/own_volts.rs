//! What one effect takes of the drive along a motion.

use super::simulated;
use crate::error::Error;
use crate::fit::scores::{EquationResidual, equation_residuals};
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use shared::effects::{EffectSet, Kind};

/// The model less one effect.
pub fn without(candidate: &Candidate, kind: Kind) -> Candidate {
    let mut effects = EffectSet::default();
    for (own, values) in candidate.effects.iter() {
        if own != kind {
            // They fitted in before.
            let _ = effects.push(own, values);
        }
    }
    Candidate {
        effects,
        ..*candidate
    }
}

/// The volts that the model without an effect misses, along the measured motion and along the model's own.
pub struct OwnVolts {
    /// Along the measured motion, V: the effect's, and whatever else is missing.
    pub missing: Vec<EquationResidual>,
    /// Along the motion of the model with the effect, V: the effect's alone, whichever state of it no recording shows.
    pub own: Vec<EquationResidual>,
}

impl OwnVolts {
    /// Of one effect of `candidate`, filtered with `time`, s.
    ///
    /// # Errors
    /// Where the model cannot run.
    pub fn of(
        data: &Data,
        candidate: &Candidate,
        kind: Kind,
        method: Method,
        time: f64,
    ) -> Result<Self, Error> {
        let bare = without(candidate, kind);
        let mut run = simulated(data, candidate, method)?;
        // Its angles are no counts.
        run.quantised = false;
        Ok(OwnVolts {
            missing: equation_residuals(data, &bare, time),
            own: equation_residuals(&run, &bare, time),
        })
    }
}
