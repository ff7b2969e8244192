//! What one effect takes of the drive along the measured motion: the catalogue's equation with fitted values, through the filter of the
//! residual.

use crate::fit::scores::{EquationResidual, equation_residuals};
use servoid_engine::problem::{Candidate, Data};
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

/// The volts that the model without an effect misses along the motion, sample by sample, and how many of them the effect accounts for.
pub struct OwnVolts {
    /// What the model without the effect misses, V.
    pub missing: Vec<EquationResidual>,
    /// The effect's part of them: at the same samples, as `missing` would be if nothing else were missing, V.
    pub own: Vec<EquationResidual>,
}

impl OwnVolts {
    /// Of one effect of `candidate`, filtered with `time`, s.
    pub fn of(data: &Data, candidate: &Candidate, kind: Kind, time: f64) -> Self {
        let missing = equation_residuals(data, &without(candidate, kind), time);
        let mut left = equation_residuals(data, candidate, time)
            .into_iter()
            .peekable();
        let (mut kept, mut own) = (Vec::new(), Vec::new());
        // A model with friction leaves out samples at which the shaft may be held.
        for residual in missing {
            while left.next_if(|left| left.sample < residual.sample).is_some() {}
            let Some(left) = left.next_if(|left| left.sample == residual.sample) else {
                continue;
            };
            own.push(EquationResidual {
                volts: residual.volts - left.volts,
                ..residual
            });
            kept.push(residual);
        }
        OwnVolts { missing: kept, own }
    }
}
