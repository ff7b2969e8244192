//! The effects of one model with their parameters.

use super::{Coupling, Kind, MAX_EFFECTS, MAX_PARAMETERS};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::Real;
use crate::units::PerUnit;

/// The effects of one model with their parameters, in SI. Copyable, no allocation.
///
/// ```
/// use shared::effects::{EffectSet, Kind};
///
/// let mut effects = EffectSet::<f64>::default();
/// // Coulomb friction of 0.9 V, referred to the winding.
/// effects.push(Kind::Coulomb, &[0.9])?;
/// let (kind, values) = effects.iter().next().expect("one effect");
/// assert_eq!((kind.name(), values), ("coulomb", &[0.9][..]));
/// # Ok::<(), shared::error::ModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectSet<R> {
    kinds: [Option<Kind>; MAX_EFFECTS],
    values: [[R; MAX_PARAMETERS]; MAX_EFFECTS],
}

impl<R: Real> Default for EffectSet<R> {
    fn default() -> Self {
        EffectSet {
            kinds: [None; MAX_EFFECTS],
            values: [[R::zero(); MAX_PARAMETERS]; MAX_EFFECTS],
        }
    }
}

impl<R: Real> EffectSet<R> {
    /// How many effects it holds.
    pub fn len(&self) -> usize {
        self.kinds.iter().flatten().count()
    }

    /// Whether it holds none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds an effect with the values of its parameters in SI.
    ///
    /// # Errors
    /// A value that is not finite; more than [`MAX_EFFECTS`] effects.
    pub fn push(&mut self, kind: Kind, values: &[R]) -> Result<(), ModelError> {
        let slot = self.len();
        if slot == MAX_EFFECTS {
            return Err(ModelError::TooManyEffects { limit: MAX_EFFECTS });
        }
        let parameters = kind.parameters();
        for (k, parameter) in parameters.iter().enumerate() {
            let value = values.get(k).copied().unwrap_or_default();
            if !value.is_finite() {
                return Err(ModelError::Parameter {
                    name: parameter.name,
                    value: value.to_f64(),
                });
            }
            self.values[slot][k] = value;
        }
        self.kinds[slot] = Some(kind);
        Ok(())
    }

    /// Each effect with its values.
    pub fn iter(&self) -> impl Iterator<Item = (Kind, &[R])> {
        self.kinds
            .iter()
            .zip(&self.values)
            .filter_map(|(kind, values)| {
                kind.map(|kind| (kind, &values[..kind.parameters().len()]))
            })
    }

    /// Each effect that does something: at least one of its amplitudes is not zero.
    pub fn present(&self) -> impl Iterator<Item = (Kind, &[R])> {
        self.iter().filter(|(kind, values)| {
            let parameters = kind.parameters();
            let mut amplitudes = parameters
                .iter()
                .zip(values.iter())
                .filter(|(parameter, _)| parameter.amplitude)
                .peekable();
            amplitudes.peek().is_none() || amplitudes.any(|(_, value)| *value != R::zero())
        })
    }

    /// Time by which commands are late, in intervals.
    pub fn delay(&self, units: &PerUnit<R>) -> R {
        self.present().fold(R::zero(), |sum, (kind, values)| {
            sum + kind.delay(values, units)
        })
    }

    /// What stands between the motor and its load, if anything, for a machine per unit.
    pub fn coupling(&self, units: &PerUnit<R>, machine: &Machine<R>) -> Option<Coupling<R>> {
        self.present()
            .filter_map(|(kind, values)| kind.coupling(values, units, machine))
            .reduce(Coupling::in_series_with)
    }
}
