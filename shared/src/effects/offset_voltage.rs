//! Constant voltage added to the command.

use super::{Description, Effect, Evidence, Facts, Other, Parameter, Place, ToldFrom};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// An offset of the power stage or of the logged command.
#[derive(Clone, Copy, Debug)]
pub struct OffsetVoltage<S> {
    volts: S,
}

lanes!(OffsetVoltage { volts });

/// An offset vanishes with the bridge open, and what acts on the shaft does not.
const fn by_a_run_down(other: &'static str) -> ToldFrom {
    ToldFrom {
        other: Other::Effect(other),
        record: "a run-down with the bridge open, where a voltage offset vanishes and a torque does not",
        measure: None,
    }
}

impl<S: Scalar> Effect<S> for OffsetVoltage<S> {
    const DESCRIPTION: Description = Description {
        name: "offset_voltage",
        place: Place::Drive,
        title: "voltage offset of the drive",
        parameters: &[Parameter::amplitude(
            "voltage",
            Quantity::Voltage,
            (-0.5, 0.5),
            0.02,
        )],
        equation: "v = u + V0",
        signature: "creeps at zero command; forward and backward differ by a constant voltage",
        exposed_by: "zero command with the bridge closed and with it open",
        look_alikes: &["load_torque", "asym_coulomb"],
        source: "any text on drives",
        facts: Facts {
            evidence: Evidence::Constant,
            told_from: &[by_a_run_down("load_torque"), by_a_run_down("asym_coulomb")],
            ..Facts::PLAIN
        },
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        OffsetVoltage {
            volts: units.number(values[0], Quantity::Voltage),
        }
    }

    #[inline(always)]
    fn drive(&self, volts: S) -> S {
        volts + self.volts
    }
}
