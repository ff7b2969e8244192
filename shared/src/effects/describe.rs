//! What an effect says about itself, for people and for programs.

use super::Facts;
use crate::units::Quantity;

/// Most parameters of one effect.
pub const MAX_PARAMETERS: usize = 6;

/// Range of a blend of two forms: neither of the two is at its end.
const FORMS: (f64, f64) = (-0.5, 1.5);

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
    /// Upper end, in the same measure, to which a search may widen the range when it ends there: what physics allows.
    pub widest: f64,
    /// A typical value, in the same measure as the range.
    pub typical: f64,
    /// Whether the effect vanishes, in proportion, as this parameter (and every other amplitude of
    /// the effect) goes to zero.
    pub amplitude: bool,
    /// Value, in the same measure as the range, at which the effect vanishes; `None` for a
    /// parameter that only shapes it.
    pub neutral: Option<f64>,
    /// Whether it changes the textbook's equation, which it is at 0. It is held there until a recording speaks for another form, so that
    /// freedom costs nothing where the textbook is right.
    pub form: Option<Form>,
}

/// How a parameter changes the textbook's equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// It blends the equation, at 0, into a relative of it, at 1.
    Blend,
    /// It is the share, from 0 to 1, of the dry friction of the other effects that acts elsewhere.
    FrictionShare,
}

impl Parameter {
    /// A parameter that the effect is proportional to, or at least vanishes with.
    pub const fn amplitude(
        name: &'static str,
        quantity: Quantity,
        range: (f64, f64),
        typical: f64,
    ) -> Self {
        Parameter {
            name,
            quantity,
            range,
            widest: range.1,
            typical,
            amplitude: true,
            neutral: Some(0.0),
            form: None,
        }
    }

    /// A parameter that shapes the effect.
    pub const fn shape(
        name: &'static str,
        quantity: Quantity,
        range: (f64, f64),
        typical: f64,
    ) -> Self {
        Parameter {
            name,
            quantity,
            range,
            widest: range.1,
            typical,
            amplitude: false,
            neutral: None,
            form: None,
        }
    }

    /// A parameter that blends the textbook's form, at 0, into the relative that the equation states, at 1. Both lie
    /// inside the range. Where a model does not state it, it is 0.
    pub const fn form(name: &'static str) -> Self {
        Parameter {
            form: Some(Form::Blend),
            ..Parameter::shape(name, Quantity::Ratio, FORMS, 0.0)
        }
    }

    /// A [share of the dry friction](Form::FrictionShare). Where a model does not state it, it is 0.
    pub const fn friction_share(name: &'static str) -> Self {
        Parameter {
            form: Some(Form::FrictionShare),
            ..Parameter::shape(name, Quantity::Ratio, (0.0, 1.0), 0.0)
        }
    }

    /// The same with a range that may be widened up to `widest`.
    #[must_use]
    pub const fn widening_to(self, widest: f64) -> Self {
        Parameter { widest, ..self }
    }

    /// A value in the measure of [`range`](Self::range), in SI, for a motor at `supply` volts
    /// that runs at `no_load` rad/s.
    pub fn scaled(&self, value: f64, supply: f64, no_load: f64) -> f64 {
        match self.quantity {
            Quantity::Voltage | Quantity::Torque => value * supply,
            Quantity::Speed => value * no_load,
            Quantity::Damping => value * supply / no_load,
            Quantity::Drag => value * supply / (no_load * no_load),
            Quantity::PerVolt => value / supply,
            Quantity::PerSquareVolt | Quantity::PerEnergy => value / (supply * supply),
            Quantity::Stiffness
            | Quantity::Inertia
            | Quantity::Time
            | Quantity::Angle
            | Quantity::Ratio
            | Quantity::Temperature
            | Quantity::PerRev
            | Quantity::Stated(_) => value,
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
    /// What is true of it beyond its equation.
    pub facts: Facts,
}
