//! The catalogue of physical effects: one effect, one file.
//!
//! An effect changes the chain from command to encoder at one place, so [`Effect`] has a hook for
//! each place, with a default that does nothing. `kinds!` at the end of this file lists the
//! effects; the enum of kinds, the names, the dispatch (a `match`, no `dyn`) and all tests that run
//! over the whole catalogue follow from that list. Its order is the number on the wire: append only.

mod cogging;
mod coulomb;
mod dead_zone;
mod load_torque;
mod offset_voltage;
mod stribeck;

use crate::error::ModelError;
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// Most effects in one model.
pub const MAX_EFFECTS: usize = 8;
/// Most parameters of one effect.
pub const MAX_PARAMETERS: usize = 4;

/// One parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name, in the field's words.
    pub name: &'static str,
    /// What it measures: its unit and its per-unit base.
    pub quantity: Quantity,
    /// Search range, relative to the motor: volts (and torques in volts) as parts of the supply,
    /// speeds as parts of the no-load speed, their quotients likewise; see [`Parameter::scaled`].
    pub range: (f64, f64),
    /// A typical value, in the same measure as the range.
    pub typical: f64,
    /// Whether the effect vanishes as this parameter goes to zero.
    pub amplitude: bool,
}

impl Parameter {
    /// A value in the measure of [`range`](Self::range), in SI, for a motor at `supply` volts
    /// that runs at `no_load` rad/s.
    pub fn scaled(&self, value: f64, supply: f64, no_load: f64) -> f64 {
        match self.quantity {
            Quantity::Voltage | Quantity::Torque => value * supply,
            Quantity::Speed => value * no_load,
            Quantity::Damping => value * supply / no_load,
            Quantity::Drag => value * supply / (no_load * no_load),
            Quantity::PerVolt => value / supply,
            Quantity::PerEnergy => value / (supply * supply),
            Quantity::Stiffness
            | Quantity::Inertia
            | Quantity::Time
            | Quantity::Angle
            | Quantity::Ratio
            | Quantity::PerRev => value,
        }
    }
}

/// Where in the chain from command to encoder an effect acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Between command and winding.
    Drive,
    /// On the winding's own constants.
    Winding,
    /// A signed torque on the shaft.
    Torque,
    /// A friction budget on the shaft.
    Friction,
    /// Beyond a spring or a gap.
    Load,
    /// Between shaft and counter.
    Sensed,
}

/// What an effect says about itself.
#[derive(Clone, Copy, Debug)]
pub struct Description {
    /// Its name on the command line and in JSON.
    pub name: &'static str,
    /// Where it acts.
    pub place: Place,
    /// One line for a person.
    pub title: &'static str,
    /// Its parameters, at most [`MAX_PARAMETERS`].
    pub parameters: &'static [Parameter],
    /// The equation.
    pub equation: &'static str,
    /// Tell-tale sign in the residual.
    pub signature: &'static str,
    /// The excitation that exposes it.
    pub exposed_by: &'static str,
    /// Names of effects that it is confused with.
    pub look_alikes: &'static [&'static str],
    /// Where the equation comes from.
    pub source: &'static str,
}

/// The state of shaft and winding that a hook may look at. Per unit.
#[derive(Clone, Copy, Debug)]
pub struct Shaft<S> {
    /// Position within a revolution, as a fraction of a turn.
    pub turns: S,
    /// Speed.
    pub speed: S,
    /// Current, as the voltage across the resistance.
    pub current: S,
}

/// A torque budget: friction that may stop the shaft and hold it, but never push it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Budget<S> {
    /// Available against motion.
    pub moving: S,
    /// Available to hold a shaft at rest.
    pub holding: S,
}

/// One physical effect, lowered to per unit in the number format `S`.
pub trait Effect<S: Scalar>: Copy {
    /// What it is.
    const DESCRIPTION: Description;
    /// Whether the hooks below depend on speed, angle or current, so that the model must look at
    /// the middle of a step rather than at its start.
    const BENDS: bool = false;
    /// Whether [`friction`](Self::friction) is used, so that stops must be located.
    const FRICTION: bool = false;

    /// From the values of its parameters in SI.
    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self;

    /// Volts that reach the winding, from the volts that were commanded.
    fn drive(&self, volts: S, _shaft: &Shaft<S>) -> S {
        volts
    }
    /// Torque against positive rotation, in volts referred to the winding.
    fn torque(&self, _shaft: &Shaft<S>) -> S {
        S::zero()
    }
    /// Friction budget.
    fn friction(&self, _shaft: &Shaft<S>) -> Budget<S> {
        Budget {
            moving: S::zero(),
            holding: S::zero(),
        }
    }
}

/// The effects of one model with their parameters, in SI. Copyable, no allocation.
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
    pub fn push(&mut self, kind: Kind, values: &[R]) -> Result<(), ModelError> {
        let slot = self.len();
        if slot == MAX_EFFECTS {
            return Err(ModelError::TooManyEffects { limit: MAX_EFFECTS });
        }
        let parameters = kind.description().parameters;
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
                kind.map(|kind| (kind, &values[..kind.description().parameters.len()]))
            })
    }
}

/// Effects lowered to per unit, ready to run.
#[derive(Clone, Copy, Debug)]
pub struct Lowered<S: Scalar> {
    effects: [Option<Any<S>>; MAX_EFFECTS],
    /// See [`Effect::BENDS`].
    pub bends: bool,
    /// See [`Effect::FRICTION`].
    pub friction: bool,
}

impl<S: Scalar> Lowered<S> {
    /// Lowers a set.
    pub fn new<R: Real>(set: &EffectSet<R>, units: &PerUnit<R>) -> Self {
        let mut lowered = Lowered {
            effects: [None; MAX_EFFECTS],
            bends: false,
            friction: false,
        };
        for (slot, (kind, values)) in lowered.effects.iter_mut().zip(set.iter()) {
            *slot = Some(kind.lower(values, units));
            lowered.bends |= kind.bends();
            lowered.friction |= kind.has_friction();
        }
        lowered
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.effects[0].is_none()
    }

    fn each(&self) -> impl Iterator<Item = &Any<S>> {
        self.effects.iter().map_while(Option::as_ref)
    }

    /// Volts at the winding.
    #[inline]
    pub fn drive(&self, volts: S, shaft: &Shaft<S>) -> S {
        self.each()
            .fold(volts, |volts, effect| effect.drive(volts, shaft))
    }

    /// Sum of the torques against positive rotation.
    #[inline]
    pub fn torque(&self, shaft: &Shaft<S>) -> S {
        self.each()
            .fold(S::zero(), |sum, effect| sum + effect.torque(shaft))
    }

    /// Sum of the friction budgets.
    #[inline]
    pub fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        let none = Budget {
            moving: S::zero(),
            holding: S::zero(),
        };
        self.each().fold(none, |sum, effect| {
            let more = effect.friction(shaft);
            Budget {
                moving: sum.moving + more.moving,
                holding: sum.holding + more.holding,
            }
        })
    }
}

/// Makes, from one list, the enum of kinds, the list of all, and the dispatch.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident in $file:ident),* $(,)?) => {
        /// The effects, in the order of their wire numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum Kind { $($(#[$doc])* $kind),* }

        impl Kind {
            /// Every effect.
            pub const ALL: &'static [Kind] = &[$(Kind::$kind),*];

            /// What it is.
            pub fn description(self) -> &'static Description {
                match self {
                    $(Kind::$kind => const { &<$file::$kind<f64> as Effect<f64>>::DESCRIPTION }),*
                }
            }

            fn bends(self) -> bool {
                match self { $(Kind::$kind => <$file::$kind<f64> as Effect<f64>>::BENDS),* }
            }

            fn has_friction(self) -> bool {
                match self { $(Kind::$kind => <$file::$kind<f64> as Effect<f64>>::FRICTION),* }
            }

            fn lower<S: Scalar, R: Real>(self, values: &[R], units: &PerUnit<R>) -> Any<S> {
                match self {
                    $(Kind::$kind => Any::$kind(<$file::$kind<S> as Effect<S>>::lower(values, units))),*
                }
            }
        }

        /// Any effect, lowered.
        #[derive(Clone, Copy, Debug)]
        enum Any<S: Scalar> { $($kind($file::$kind<S>)),* }

        impl<S: Scalar> Any<S> {
            #[inline(always)]
            fn drive(&self, volts: S, shaft: &Shaft<S>) -> S {
                match self { $(Any::$kind(effect) => effect.drive(volts, shaft)),* }
            }
            #[inline(always)]
            fn torque(&self, shaft: &Shaft<S>) -> S {
                match self { $(Any::$kind(effect) => effect.torque(shaft)),* }
            }
            #[inline(always)]
            fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
                match self { $(Any::$kind(effect) => effect.friction(shaft)),* }
            }
        }
    };
}

kinds! {
    /// Friction of constant size against motion.
    Coulomb in coulomb,
    /// Coulomb friction that is larger near standstill.
    Stribeck in stribeck,
    /// Torque that depends on the angle through the magnets and teeth.
    Cogging in cogging,
    /// Constant torque on the shaft.
    LoadTorque in load_torque,
    /// The power stage gives nothing for small commands.
    DeadZone in dead_zone,
    /// Constant voltage added to the command.
    OffsetVoltage in offset_voltage,
}

impl Kind {
    /// Its name.
    pub fn name(self) -> &'static str {
        self.description().name
    }

    /// The effect called `name`.
    pub fn by_name(name: &str) -> Option<Kind> {
        Kind::ALL.iter().copied().find(|kind| kind.name() == name)
    }
}
