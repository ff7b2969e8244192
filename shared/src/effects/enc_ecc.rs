//! Eccentricity of the encoder's disc or magnet.

use super::{
    Description, Effect, Facts, Needs, Order, Other, Pair, Parameter, Place, ToldFrom,
    harmonic::Harmonic,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// The encoder sees `θ + A·cos θ + B·sin θ`; a disc of radius `r` that sits off its axis by `e` has
/// the amplitude `e/r`. The motion itself is not touched.
#[derive(Clone, Copy, Debug)]
pub struct EncEcc<S: Scalar> {
    error: Harmonic<S>,
}

lanes!(EncEcc { error });

/// An error of the angle stays where a torque shrinks.
const fn by_several_speeds(other: &'static str) -> ToldFrom {
    ToldFrom {
        other: Other::Effect(other),
        record: "constant runs at several speeds: an error of the angle stays the same, a torque shrinks as speed rises",
        measure: None,
    }
}

impl<S: Scalar> Effect<S> for EncEcc<S> {
    const DESCRIPTION: Description = Description {
        name: "enc_ecc",
        place: Place::Sensed,
        title: "eccentric encoder",
        parameters: &[
            Parameter::amplitude("cosine", Quantity::Angle, (-0.1, 0.1), 0.003),
            Parameter::amplitude("sine", Quantity::Angle, (-0.1, 0.1), 0.005),
        ],
        equation: "reading = theta + A*cos(theta) + B*sin(theta)",
        signature: "angle error once a revolution, the same at every speed, load and direction",
        exposed_by: "constant high speed, where the inertia holds the speed",
        look_alikes: &["unbalance", "cogging"],
        source: "the triangle of axis, disc centre and reading head; TI TIDUFF8",
        facts: Facts {
            periodic: Some(Order::Once),
            pair: Some(Pair::CosineAndSine),
            told_from: &[by_several_speeds("cogging"), by_several_speeds("unbalance")],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        sensed: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        EncEcc {
            error: Harmonic::new(
                units.number(values[0], Quantity::Angle),
                units.number(values[1], Quantity::Angle),
                1.0,
            ),
        }
    }

    #[inline(always)]
    fn sensed(&self, turns: S, _memory: S) -> S {
        self.error.at(turns)
    }
}
