//! Dead zone of the power stage.

use super::{Description, Effect, Evidence, Facts, Parameter, Place, Starts};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// The stage loses `V0` of the command's magnitude, and gives nothing below it.
///
/// Its form is blended into a stage that leaves short pulses out and passes long ones whole.
#[derive(Clone, Copy, Debug)]
pub struct DeadZone<S> {
    volts: S,
    /// Volts that come back beyond the zone.
    back: S,
}

lanes!(DeadZone { volts, back });

impl<S: Scalar> Effect<S> for DeadZone<S> {
    const DESCRIPTION: Description = Description {
        name: "dead_zone",
        place: Place::Drive,
        title: "dead zone of the power stage",
        parameters: &[
            Parameter::amplitude("voltage", Quantity::Voltage, (0.0, 0.5), 0.03),
            Parameter::form("form"),
        ],
        equation: "v = 0 for |u| <= V0, else u - (1 - f)*V0*sgn(u)",
        signature: "no motion below a command that is the same at all angles; a constant voltage missing above it",
        exposed_by: "a slow triangle of small amplitude",
        look_alikes: &["coulomb", "brush_drop", "stribeck"],
        source: "Kara, Eker, Energy Conversion and Management 45, 2004; Tao, Kokotovic, Adaptive Control of Systems with Actuator and Sensor Nonlinearities, 1996",
        facts: Facts {
            both_forms: true,
            // Of a stage that passes long pulses whole, a command shows only on which side of the zone it is: from afar there is
            // no slope.
            starts: Starts::Shares(&[(0, &[0.6, 1.8, 5.0])]),
            evidence: Evidence::ChangesSign,
            ..Facts::PLAIN
        },
    };
    const ORDER: u8 = 1;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        DeadZone {
            volts: units.number(values[0], Quantity::Voltage),
            back: units.number(values[0] * values[1], Quantity::Voltage),
        }
    }

    #[inline(always)]
    fn drive(&self, volts: S) -> S {
        let lost = volts.min(self.volts).max(-self.volts);
        let beyond = self.volts.less(volts.abs());
        let back = S::select(beyond, self.back * volts.signum(), S::zero());
        volts - lost + back
    }
}
