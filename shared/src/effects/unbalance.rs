//! An eccentric mass on a horizontal shaft.

use super::{
    AtSpeed, Description, Effect, Evidence, Facts, Needs, Order, Other, Pair, Parameter, Place,
    Shaft, ToldFrom, harmonic::Harmonic,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Gravity on a mass off the axis: `A·cos θ + B·sin θ`. What the mass adds to the inertia is part of
/// the machine's.
#[derive(Clone, Copy, Debug)]
pub struct Unbalance<S: Scalar> {
    torque: Harmonic<S>,
}

lanes!(Unbalance { torque });

impl<S: Scalar> Effect<S> for Unbalance<S> {
    const DESCRIPTION: Description = Description {
        name: "unbalance",
        place: Place::Torque,
        title: "unbalance (gravity on an eccentric mass)",
        parameters: &[
            Parameter::amplitude("cosine_torque", Quantity::Torque, (-0.3, 0.3), 0.02),
            Parameter::amplitude("sine_torque", Quantity::Torque, (-0.3, 0.3), 0.02),
        ],
        equation: "T = A*cos(theta) + B*sin(theta)",
        signature: "residual torque once a revolution, its phase fixed to the vertical",
        exposed_by: "a slow full turn both ways",
        look_alikes: &["cogging", "enc_ecc", "load_torque"],
        source: "any text on mechanics; m*g*e is the weight's largest torque",
        facts: Facts {
            evidence: Evidence::Repeats,
            periodic: Some(Order::Once),
            pair: Some(Pair::CosineAndSine),
            at_speed: AtSpeed::OtherForm("a torque that depends on the angle has no place here"),
            told_from: &[ToldFrom {
                other: Other::Effect("cogging"),
                record: "the same run with the bench tilted or the motor turned by 90 degrees: gravity stays where it was",
                measure: None,
            }],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        angle: true,
        torque: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        Unbalance {
            torque: Harmonic::new(
                units.number(values[0], Quantity::Torque),
                units.number(values[1], Quantity::Torque),
                1.0,
            ),
        }
    }

    #[inline(always)]
    fn torque(&self, shaft: &Shaft<S>, _memory: S) -> S {
        self.torque.mean(shaft)
    }
}
