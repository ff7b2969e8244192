//! Cogging: the magnets prefer some angles.

use super::{
    AtSpeed, Description, Effect, Evidence, Facts, Needs, Order, Pair, Parameter, Place, Shaft,
    Starts, harmonic::Harmonic,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// One angle order of torque: `A·cos(kθ) + B·sin(kθ)`, the same in both directions and at all
/// speeds and currents.
#[derive(Clone, Copy, Debug)]
pub struct Cogging<S: Scalar> {
    torque: Harmonic<S>,
}

lanes!(Cogging { torque });

impl<S: Scalar> Effect<S> for Cogging<S> {
    const DESCRIPTION: Description = Description {
        name: "cogging",
        place: Place::Torque,
        title: "cogging torque",
        parameters: &[
            Parameter::amplitude("cosine_torque", Quantity::Torque, (-0.3, 0.3), 0.03),
            Parameter::amplitude("sine_torque", Quantity::Torque, (-0.3, 0.3), 0.02),
            Parameter::shape("order", Quantity::PerRev, (2.0, 128.0), 12.0),
        ],
        equation: "T = A*cos(k*theta) + B*sin(k*theta), k cycles a revolution",
        signature: "lines of the residual torque at fixed angle orders, alike in both directions and at all speeds",
        exposed_by: "creeping at least three turns both ways",
        look_alikes: &["unbalance", "enc_ecc"],
        source: "Piccoli, Yim, Robotics: Science and Systems, 2014",
        facts: Facts {
            starts: Starts::AngleOrders,
            evidence: Evidence::Repeats,
            periodic: Some(Order::Parameter(2)),
            pair: Some(Pair::CosineAndSine),
            at_speed: AtSpeed::OtherForm("a torque that depends on the angle has no place here"),
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
        Cogging {
            torque: Harmonic::new(
                units.number(values[0], Quantity::Torque),
                units.number(values[1], Quantity::Torque),
                values[2].to_f64(),
            ),
        }
    }

    #[inline(always)]
    fn torque(&self, shaft: &Shaft<S>, _memory: S) -> S {
        self.torque.mean(shaft)
    }
}
