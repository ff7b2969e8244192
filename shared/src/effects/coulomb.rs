//! Coulomb friction.

use super::{Budget, Description, Effect, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Friction of constant size `Tc` against motion; at rest it holds up to the same size.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb<S> {
    torque: S,
}

lanes!(Coulomb { torque });

impl<S: Scalar> Effect<S> for Coulomb<S> {
    const DESCRIPTION: Description = Description {
        name: "coulomb",
        place: Place::Friction,
        title: "Coulomb friction",
        parameters: &[Parameter::amplitude(
            "torque",
            Quantity::Torque,
            (0.0, 0.5),
            0.04,
        )],
        equation: "T = Tc*sgn(w); |T| <= Tc at rest",
        signature: "residual torque changes sign with speed and does not grow with it",
        exposed_by: "a slow triangle through zero, or steps of both signs",
        look_alikes: &["stribeck", "asym_coulomb", "brush_drop", "lugre"],
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994",
    };
    const NEEDS: Needs = Needs {
        friction: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        Coulomb {
            torque: units.number(values[0], Quantity::Torque),
        }
    }

    #[inline(always)]
    fn friction(&self, _shaft: &Shaft<S>) -> Budget<S> {
        Budget::even(self.torque)
    }
}
