//! Dead zone of the power stage.

use super::{Description, Effect, Evidence, Facts, Parameter, Place};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// The stage loses `V0` of the command's magnitude, and gives nothing below it.
#[derive(Clone, Copy, Debug)]
pub struct DeadZone<S> {
    volts: S,
}

lanes!(DeadZone { volts });

impl<S: Scalar> Effect<S> for DeadZone<S> {
    const DESCRIPTION: Description = Description {
        name: "dead_zone",
        place: Place::Drive,
        title: "dead zone of the power stage",
        parameters: &[Parameter::amplitude(
            "voltage",
            Quantity::Voltage,
            (0.0, 0.5),
            0.03,
        )],
        equation: "v = sgn(u)*max(|u| - V0, 0)",
        signature: "no motion below a command that is the same at all angles; a constant voltage missing above it",
        exposed_by: "a slow triangle of small amplitude",
        look_alikes: &["coulomb", "brush_drop", "stribeck"],
        source: "Kara, Eker, Energy Conversion and Management 45, 2004",
        facts: Facts {
            evidence: Evidence::ChangesSign,
            ..Facts::PLAIN
        },
    };
    const ORDER: u8 = 1;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        DeadZone {
            volts: units.number(values[0], Quantity::Voltage),
        }
    }

    #[inline(always)]
    fn drive(&self, volts: S) -> S {
        volts - volts.min(self.volts).max(-self.volts)
    }
}
