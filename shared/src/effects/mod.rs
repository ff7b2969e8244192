//! The catalogue of physical effects: one effect, one file.
//!
//! An effect changes the chain from command to encoder at one place, so [`Effect`] has a hook for
//! each place, with a default that does nothing. `kinds!` at the end of this file lists the
//! effects; the enum of kinds, the names, the dispatch (a `match`, no `dyn`) and all tests that run
//! over the whole catalogue follow from that list. Its order is the number on the wire: append only.
//!
//! To add one: write its file, then add its `mod` line and its line in `kinds!`. A law that a user states is a [`formula`].

mod asym_coulomb;
mod asym_viscous;
mod backlash;
mod brush_drop;
mod cogging;
mod compliance;
mod coulomb;
mod dead_time;
mod dead_zone;
mod delay;
mod enc_ecc;
mod heating;
mod l_sat;
mod load_friction;
mod load_torque;
mod lugre;
mod missed_counts;
mod offset_voltage;
mod stribeck;
mod supply_sag;
mod torque_sat;
mod unbalance;
mod voltage_sat;
mod windage;

mod brush;
mod chebyshev;
mod decay;
mod describe;
mod facts;
pub mod formula;
mod harmonic;
mod hump;
mod lowered;
mod quotient;
mod set;
mod shaft;
mod tangent;

pub use brush::{Brush, Spared, WHOLE_DROP};
pub use describe::{Description, Form, MAX_PARAMETERS, Parameter, Place};
pub use facts::{AtSpeed, Contained, Evidence, Facts, Order, Other, Pair, Starts, ToldFrom, Value};
pub use lowered::Lowered;
pub use set::EffectSet;
pub use shaft::{Budget, Coupling, Shaft, Stiff, Winding};

use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{FromLanes, Real, Scalar};
use crate::units::PerUnit;
use formula::{Formula, Stated};

/// Most effects in one model.
pub const MAX_EFFECTS: usize = 8;
/// Most numbers that an effect remembers: those of the catalogue one, a stated law two.
pub const MEMORIES: usize = 2;
/// What an effect remembers, zero at first.
pub type Memory<S> = [S; MEMORIES];

/// What an effect needs of the model, so that no model pays for what it has not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// Its hooks depend on speed, angle or current: they are asked twice, for the start and for
    /// the mean of each part.
    pub mean: bool,
    /// It depends on the current, which may jump with the voltage: parts are short after a jump.
    pub current: bool,
    /// It looks at [`Shaft::turns`].
    pub angle: bool,
    /// It has a friction budget, so that stops must be located.
    pub friction: bool,
    /// It changes the winding or drops voltage at the brushes.
    pub winding: bool,
    /// It gives a torque.
    pub torque: bool,
    /// It gives a stiff torque.
    pub stiff: bool,
    /// It takes a torque from the current.
    pub lost_torque: bool,
    /// It remembers a number.
    pub memory: bool,
    /// It changes what the encoder sees.
    pub sensed: bool,
    /// It looks at [`Shaft::temperature`].
    pub temperature: bool,
}

impl Needs {
    /// Nothing but the command or a constant torque.
    pub const NOTHING: Needs = Needs {
        mean: false,
        current: false,
        angle: false,
        friction: false,
        winding: false,
        torque: false,
        stiff: false,
        lost_torque: false,
        memory: false,
        sensed: false,
        temperature: false,
    };

    /// Volts that depend on the current.
    pub const VOLTS_BY_CURRENT: Needs = Needs {
        mean: true,
        current: true,
        winding: true,
        ..Needs::NOTHING
    };

    /// What either needs.
    #[inline(always)]
    pub fn or(self, other: Needs) -> Needs {
        Needs {
            mean: self.mean | other.mean,
            current: self.current | other.current,
            angle: self.angle | other.angle,
            friction: self.friction | other.friction,
            winding: self.winding | other.winding,
            torque: self.torque | other.torque,
            stiff: self.stiff | other.stiff,
            lost_torque: self.lost_torque | other.lost_torque,
            memory: self.memory | other.memory,
            sensed: self.sensed | other.sensed,
            temperature: self.temperature | other.temperature,
        }
    }
}

/// One physical effect, lowered to per unit in the number format `S`. An effect overrides the hook
/// of the place where it acts.
///
/// Hooks see the mean of a part of a step. That is enough for what is nearly linear within a part;
/// what is not can average over the part itself, see [`Shaft::mean_over_speed`].
pub trait Effect<S: Scalar>: Copy {
    /// What it is.
    const DESCRIPTION: Description;
    /// What it needs of the model.
    const NEEDS: Needs = Needs::NOTHING;
    /// Where the command meets it: effects with a [`drive`](Self::drive) act in rising order,
    /// however a model lists them.
    const ORDER: u8 = 0;

    /// From the values of its parameters in SI.
    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self;

    /// Time by which the command is late, in intervals.
    fn delay<R: Real>(_values: &[R], _units: &PerUnit<R>) -> R {
        R::zero()
    }
    /// What stands between the motor and its load, for a machine per unit.
    fn coupling<R: Real>(
        _values: &[R],
        _units: &PerUnit<R>,
        _machine: &Machine<R>,
    ) -> Option<Coupling<R>> {
        None
    }
    /// Volts behind this effect, from those before it.
    #[inline(always)]
    fn drive(&self, volts: S) -> S {
        volts
    }
    /// Voltage lost against the current, by the brushes or by the bridge's dead time.
    #[inline(always)]
    fn brush(&self) -> Brush<S> {
        Brush::default()
    }
    /// Changes of the winding.
    #[inline(always)]
    fn winding(&self, _shaft: &Shaft<S>, _memory: S) -> Winding<S> {
        Winding::default()
    }
    /// Torque against positive rotation, in volts referred to the winding.
    #[inline(always)]
    fn torque(&self, _shaft: &Shaft<S>, _memory: S) -> S {
        S::zero()
    }
    /// Torque against positive rotation that rises steeply with the travel of the part.
    #[inline(always)]
    fn stiff(&self, _shaft: &Shaft<S>, _memory: S) -> Stiff<S> {
        Stiff::default()
    }
    /// Torque that the current should give and does not.
    #[inline(always)]
    fn lost_torque(&self, _shaft: &Shaft<S>, _memory: S) -> S {
        S::zero()
    }
    /// Friction budget.
    #[inline(always)]
    fn friction(&self, _shaft: &Shaft<S>) -> Budget<S> {
        Budget::default()
    }
    /// What it remembers after a part; nothing in it may depend on the sample interval.
    #[inline(always)]
    fn remember(&self, memory: S, _shaft: &Shaft<S>) -> S {
        memory
    }
    /// Error of the angle that the encoder sees, in turns, at a position within the revolution.
    #[inline(always)]
    fn sensed(&self, _turns: S, _memory: S) -> S {
        S::zero()
    }
}

/// Makes, from one list, the enum of kinds, the list of all, and the dispatch.
macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident in $file:ident),* $(,)?) => {
        /// The effects, in the order of their wire numbers.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u8)]
        pub enum Kind {
            $($(#[$doc])* $kind,)*
            /// A law that the user stated.
            Formula(&'static Formula),
        }

        impl Kind {
            /// Every effect of the catalogue.
            pub const ALL: &'static [Kind] = &[$(Kind::$kind),*];

            /// What it is. Nothing that runs on a device reads it, so that its texts stay out of the image.
            pub fn description(self) -> &'static Description {
                match self {
                    $(Kind::$kind => const { &<$file::$kind<f64> as Effect<f64>>::DESCRIPTION },)*
                    Kind::Formula(formula) => &formula.description,
                }
            }

            /// Its name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Kind::$kind => const { <$file::$kind<f64> as Effect<f64>>::DESCRIPTION.name },)*
                    Kind::Formula(formula) => formula.description.name,
                }
            }

            /// Its parameters.
            pub fn parameters(self) -> &'static [Parameter] {
                match self {
                    $(Kind::$kind => const { <$file::$kind<f64> as Effect<f64>>::DESCRIPTION.parameters },)*
                    Kind::Formula(formula) => formula.description.parameters,
                }
            }

            /// How its last parameter changes the textbook's equation, if it does: an effect has one form at most.
            pub fn form(self) -> Option<Form> {
                self.parameters().last().and_then(|parameter| parameter.form)
            }

            /// What it needs of the model.
            pub fn needs(self) -> Needs {
                match self {
                    $(Kind::$kind => <$file::$kind<f64> as Effect<f64>>::NEEDS,)*
                    Kind::Formula(formula) => formula.program.needs(),
                }
            }

            /// Whether it can run where nothing tells the temperature.
            ///
            /// # Errors
            /// [`ModelError::NoTemperature`].
            pub fn check_without_temperature(self) -> Result<(), ModelError> {
                match self.needs().temperature {
                    true => Err(ModelError::NoTemperature { name: self.name() }),
                    false => Ok(()),
                }
            }

            /// Place in the order in which effects act.
            fn rank(self) -> u16 {
                let order = match self {
                    $(Kind::$kind => <$file::$kind<f64> as Effect<f64>>::ORDER,)*
                    Kind::Formula(_) => u8::MAX,
                };
                let number = Kind::ALL.iter().position(|kind| *kind == self);
                (order as u16) << 8 | number.unwrap_or(usize::from(u8::MAX)) as u16
            }

            fn delay<R: Real>(self, values: &[R], units: &PerUnit<R>) -> R {
                match self {
                    $(Kind::$kind => <$file::$kind<f64> as Effect<f64>>::delay(values, units),)*
                    Kind::Formula(_) => R::zero(),
                }
            }

            fn coupling<R: Real>(
                self,
                values: &[R],
                units: &PerUnit<R>,
                machine: &Machine<R>,
            ) -> Option<Coupling<R>> {
                match self {
                    $(Kind::$kind =>
                        <$file::$kind<f64> as Effect<f64>>::coupling(values, units, machine),)*
                    Kind::Formula(_) => None,
                }
            }

            /// Whether the number format `S` can hold it; of the catalogue's effects it can hold all.
            pub(crate) fn check<S: Scalar, R: Real>(
                self,
                values: &[R],
                units: &PerUnit<R>,
            ) -> Result<(), ModelError> {
                match self {
                    Kind::Formula(formula) => formula.check::<S, R>(values, units),
                    _ => Ok(()),
                }
            }

            fn lower<S: Scalar, R: Real>(self, values: &[R], units: &PerUnit<R>) -> Any<S> {
                match self {
                    $(Kind::$kind => Any::$kind(<$file::$kind<S> as Effect<S>>::lower(values, units)),)*
                    Kind::Formula(formula) => Any::Formula(Stated::lower(formula, values, units)),
                }
            }
        }

        /// Any effect, lowered.
        #[derive(Clone, Copy, Debug)]
        enum Any<S: Scalar> {
            $($kind($file::$kind<S>),)*
            Formula(Stated<S>),
        }

        impl<W, const N: usize> FromLanes<Any<f64>, N> for Any<W>
        where
            W: Scalar<Coefficient = W, Angle = W> + From<[f64; N]>,
        {
            fn from_lanes(each: [&Any<f64>; N]) -> Option<Self> {
                match each[0] {
                    $(Any::$kind(first) => {
                        let mut own = [first; N];
                        for (own, one) in own.iter_mut().zip(each) {
                            let Any::$kind(effect) = one else { return None };
                            *own = effect;
                        }
                        Some(Any::$kind(FromLanes::from_lanes(own)?))
                    },)*
                    Any::Formula(first) => {
                        let mut own = [first; N];
                        for (own, one) in own.iter_mut().zip(each) {
                            let Any::Formula(effect) = one else { return None };
                            *own = effect;
                        }
                        Some(Any::Formula(FromLanes::from_lanes(own)?))
                    }
                }
            }
        }

        impl<S: Scalar> Any<S> {
            #[inline(always)]
            fn drive(&self, volts: S) -> S {
                match self {
                    $(Any::$kind(effect) => effect.drive(volts),)*
                    Any::Formula(effect) => effect.drive(volts),
                }
            }
            #[inline(always)]
            fn brush(&self) -> Brush<S> {
                match self {
                    $(Any::$kind(effect) => effect.brush(),)*
                    Any::Formula(_) => Brush::default(),
                }
            }
            #[inline(always)]
            fn winding(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> Winding<S> {
                match self {
                    $(Any::$kind(effect) => effect.winding(shaft, memory[0]),)*
                    Any::Formula(effect) => effect.winding(shaft, memory),
                }
            }
            #[inline(always)]
            fn torque(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> S {
                match self {
                    $(Any::$kind(effect) => effect.torque(shaft, memory[0]),)*
                    Any::Formula(effect) => effect.torque(shaft, memory),
                }
            }
            #[inline(always)]
            fn stiff(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> Stiff<S> {
                match self {
                    $(Any::$kind(effect) => effect.stiff(shaft, memory[0]),)*
                    Any::Formula(effect) => effect.stiff(shaft, memory),
                }
            }
            #[inline(always)]
            fn lost_torque(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> S {
                match self {
                    $(Any::$kind(effect) => effect.lost_torque(shaft, memory[0]),)*
                    Any::Formula(effect) => effect.lost_torque(shaft, memory),
                }
            }
            #[inline(always)]
            fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
                match self {
                    $(Any::$kind(effect) => effect.friction(shaft),)*
                    Any::Formula(effect) => effect.friction(shaft),
                }
            }
            #[inline(always)]
            fn remember(&self, memory: &Memory<S>, shaft: &Shaft<S>) -> Memory<S> {
                match self {
                    $(Any::$kind(effect) => [effect.remember(memory[0], shaft), memory[1]],)*
                    Any::Formula(effect) => effect.remember(memory, shaft),
                }
            }
            #[inline(always)]
            fn sensed(&self, turns: S, memory: &Memory<S>) -> S {
                match self {
                    $(Any::$kind(effect) => effect.sensed(turns, memory[0]),)*
                    Any::Formula(effect) => effect.sensed(turns),
                }
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
    /// Friction of different size in the two directions.
    AsymCoulomb in asym_coulomb,
    /// Drag on the square of the speed.
    Windage in windage,
    /// Gravity on an eccentric mass.
    Unbalance in unbalance,
    /// A load behind a gap.
    Backlash in backlash,
    /// A load behind a spring.
    Compliance in compliance,
    /// Voltage lost at the brushes.
    BrushDrop in brush_drop,
    /// The supply falls with the current drawn.
    SupplySag in supply_sag,
    /// Large commands are clipped.
    VoltageSat in voltage_sat,
    /// Large currents give less torque than their share.
    TorqueSat in torque_sat,
    /// The inductance falls as the current grows.
    LSat in l_sat,
    /// The winding heats up.
    Heating in heating,
    /// Commands arrive late.
    Delay in delay,
    /// The encoder's disc is off centre.
    EncEcc in enc_ecc,
    /// The counter misses counts.
    MissedCounts in missed_counts,
    /// Friction whose bristles bend before they slide.
    Lugre in lugre,
    /// Viscous friction of different size in the two directions.
    AsymViscous in asym_viscous,
    /// Friction that grows with the torque passed on.
    LoadFriction in load_friction,
    /// Voltage lost while both transistors of a bridge's leg are off.
    DeadTime in dead_time,
}

impl Kind {
    /// The effect called `name`.
    pub fn by_name(name: &str) -> Option<Kind> {
        Kind::ALL.iter().copied().find(|kind| kind.name() == name)
    }
}
