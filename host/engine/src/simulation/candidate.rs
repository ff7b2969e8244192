//! A model with all its numbers, and how it is stepped.

use shared::discretise::Discretisation;
use shared::effects::{EffectSet, Kind};
use shared::motor::Machine;

/// A model with all its numbers, in SI.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// The linear machine.
    pub machine: Machine<f64>,
    /// Effects with their parameters.
    pub effects: EffectSet<f64>,
    /// Speed at the first sample, rad/s.
    pub start_speed: f64,
    /// Angle at the first sample from the middle of its cell, counts. It matters where effects depend on
    /// the angle; elsewhere the best shift of the whole run does the same.
    pub start_offset: f64,
}

impl Candidate {
    /// The model with those of its effects that `keep` keeps.
    pub fn keeping(&self, keep: impl Fn(Kind) -> bool) -> Self {
        let mut effects = EffectSet::default();
        for (kind, values) in self.effects.iter().filter(|(kind, _)| keep(*kind)) {
            // They fitted in before.
            let _ = effects.push(kind, values);
        }
        Candidate { effects, ..*self }
    }

    /// The model less one effect.
    pub fn without(&self, kind: Kind) -> Self {
        self.keeping(|own| own != kind)
    }

    /// Whether an effect depends on the absolute angle.
    pub fn needs_angle(&self) -> bool {
        self.effects.iter().any(|(kind, _)| kind.needs().angle)
    }
}

/// How a candidate is run.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// Exact, or the paper's Euler step.
    pub discretisation: Discretisation,
    /// Steps to a sample interval where there are effects.
    pub substeps: u16,
}

impl Default for Method {
    fn default() -> Self {
        Method {
            discretisation: Discretisation::Exact,
            substeps: 1,
        }
    }
}
