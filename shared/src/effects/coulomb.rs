//! Coulomb friction.

use super::{
    AtSpeed, Budget, Description, Effect, Evidence, Facts, Needs, Other, Parameter, Place, Shaft,
    ToldFrom,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Friction of constant size `Tc` against motion; at rest it holds up to the same size.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb<S> {
    torque: S,
}

lanes!(Coulomb { torque });

/// All that is electrical vanishes with the bridge open, and friction stays.
pub(super) const ELECTRICAL: ToldFrom = ToldFrom {
    other: Other::At(Place::Drive),
    record: "a run-down with the bridge open, where all that is electrical vanishes and friction stays, or log the \
             current",
    measure: None,
};

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
        facts: Facts {
            evidence: Evidence::ChangesSign,
            at_speed: AtSpeed::Sliding {
                mean_of: &[0],
                without: None,
            },
            told_from: &[ELECTRICAL],
            ..Facts::PLAIN
        },
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
