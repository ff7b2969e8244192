//! What a model is made of, in SI.

use crate::discretise::Discretisation;
use crate::effects::EffectSet;
use crate::motor::Machine;
use crate::scalar::Real;
use crate::units::PerUnit;

/// What a model is made of, in SI.
#[derive(Clone, Copy, Debug)]
pub struct Plan<R> {
    /// The linear machine.
    pub machine: Machine<R>,
    /// Effects with their parameters.
    pub effects: EffectSet<R>,
    /// Bases of the per-unit system; one interval is one step.
    pub units: PerUnit<R>,
    /// Exact, or the paper's Euler step.
    pub discretisation: Discretisation,
    /// Substeps of an interval where effects bend the path; at least 1.
    pub substeps: u16,
}

impl<R: Real> Plan<R> {
    /// The linear machine without effects, discretised exactly.
    #[inline(always)]
    pub fn linear(machine: Machine<R>, units: PerUnit<R>) -> Self {
        Plan {
            machine,
            effects: EffectSet::default(),
            units,
            discretisation: Discretisation::Exact,
            substeps: 1,
        }
    }
}
