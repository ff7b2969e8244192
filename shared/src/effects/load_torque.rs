//! Constant torque on the shaft.

use super::{
    AtSpeed, Description, Effect, Evidence, Facts, Needs, Other, Parameter, Place, Shaft, ToldFrom,
};
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
        facts: Facts {
            evidence: Evidence::Constant,
            at_speed: AtSpeed::OtherForm("a constant torque has no place here"),
            told_from: &[ToldFrom {
                other: Other::Effect("asym_coulomb"),
                record: "a hold at rest and slow creeping back: a load acts at rest, unequal friction only holds",
                measure: Some(
                    "a hold at several angles with a creep back: a load acts at rest, friction does not",
                ),
            }],
            ..Facts::PLAIN
        },
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
