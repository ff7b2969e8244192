//! Cogging: the magnets prefer some angles.

use super::{Description, Effect, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// One angle order of torque: `A·cos(kθ) + B·sin(kθ)`, the same in both directions and at all
/// speeds and currents.
#[derive(Clone, Copy, Debug)]
pub struct Cogging<S: Scalar> {
    order: S::Coefficient,
    cosine: S,
    sine: S,
}

impl<S: Scalar> Effect<S> for Cogging<S> {
    const DESCRIPTION: Description = Description {
        name: "cogging",
        place: Place::Torque,
        title: "cogging torque",
        parameters: &[
            Parameter {
                name: "cosine_torque",
                quantity: Quantity::Torque,
                range: (-0.3, 0.3),
                typical: 0.03,
                amplitude: true,
            },
            Parameter {
                name: "sine_torque",
                quantity: Quantity::Torque,
                range: (-0.3, 0.3),
                typical: 0.02,
                amplitude: true,
            },
            Parameter {
                name: "order",
                quantity: Quantity::PerRev,
                range: (2.0, 128.0),
                typical: 12.0,
                amplitude: false,
            },
        ],
        equation: "T = A*cos(k*theta) + B*sin(k*theta), k cycles a revolution",
        signature: "lines of the residual torque at fixed angle orders, alike in both directions and at all speeds",
        exposed_by: "creeping at least three turns both ways",
        look_alikes: &["unbalance", "enc_ecc"],
        source: "Piccoli, Yim, Robotics: Science and Systems, 2014",
    };
    const BENDS: bool = true;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        Cogging {
            cosine: S::from_f64(units.lower(values[0], Quantity::Torque).to_f64()),
            sine: S::from_f64(units.lower(values[1], Quantity::Torque).to_f64()),
            // Orders are whole: the torque must be the same after a full turn.
            order: S::coefficient(libm::round(values[2].to_f64())),
        }
    }

    #[inline]
    fn torque(&self, shaft: &Shaft<S>) -> S {
        let (sine, cosine) = shaft.turns.times(self.order).sin_cos_turns();
        self.cosine * cosine + self.sine * sine
    }
}
