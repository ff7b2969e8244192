//! Constant torque on the shaft.

use super::{Description, Effect, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// A constant torque against positive rotation, as of a weight on a drum.
#[derive(Clone, Copy, Debug)]
pub struct LoadTorque<S> {
    torque: S,
}

lanes!(LoadTorque { torque });

impl<S: Scalar> Effect<S> for LoadTorque<S> {
    const DESCRIPTION: Description = Description {
        name: "load_torque",
        place: Place::Torque,
        title: "constant load torque",
        parameters: &[Parameter::amplitude(
            "torque",
            Quantity::Torque,
            (-0.5, 0.5),
            0.04,
        )],
        equation: "T = T0",
        signature: "constant residual torque, also at rest and with the bridge open",
        exposed_by: "coasting with the bridge open, or holding at rest",
        look_alikes: &["offset_voltage", "asym_coulomb"],
        source: "any text on drives",
    };
    const NEEDS: Needs = Needs {
        torque: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        LoadTorque {
            torque: units.number(values[0], Quantity::Torque),
        }
    }

    #[inline(always)]
    fn torque(&self, _shaft: &Shaft<S>, _memory: S) -> S {
        self.torque
    }
}
