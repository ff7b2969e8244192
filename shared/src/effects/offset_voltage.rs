//! Constant voltage added to the command.

use super::{Description, Effect, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// An offset of the power stage or of the logged command.
#[derive(Clone, Copy, Debug)]
pub struct OffsetVoltage<S> {
    volts: S,
}

impl<S: Scalar> Effect<S> for OffsetVoltage<S> {
    const DESCRIPTION: Description = Description {
        name: "offset_voltage",
        place: Place::Drive,
        title: "voltage offset of the drive",
        parameters: &[Parameter {
            name: "voltage",
            quantity: Quantity::Voltage,
            range: (-0.5, 0.5),
            typical: 0.02,
            amplitude: true,
        }],
        equation: "v = u + V0",
        signature: "creeps at zero command; forward and backward differ by a constant voltage",
        exposed_by: "zero command with the bridge closed and with it open",
        look_alikes: &["load_torque", "asym_coulomb"],
        source: "any text on drives",
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        OffsetVoltage {
            volts: S::from_f64(units.lower(values[0], Quantity::Voltage).to_f64()),
        }
    }

    #[inline(always)]
    fn drive(&self, volts: S, _shaft: &Shaft<S>) -> S {
        volts + self.volts
    }
}
