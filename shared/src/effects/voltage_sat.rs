//! The power stage clips.

use super::{Description, Effect, Facts, Other, Parameter, Place, Starts, ToldFrom};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Commands beyond `±V1` give `±V1`. There is nothing to see where no command reaches the limit.
#[derive(Clone, Copy, Debug)]
pub struct VoltageSat<S> {
    limit: S,
}

lanes!(VoltageSat { limit });

impl<S: Scalar> Effect<S> for VoltageSat<S> {
    const DESCRIPTION: Description = Description {
        name: "voltage_sat",
        place: Place::Drive,
        title: "clipped voltage of the power stage",
        parameters: &[Parameter {
            neutral: Some(1.0),
            ..Parameter::shape("limit", Quantity::Voltage, (0.3, 1.0), 0.85)
        }],
        equation: "v = max(-V1, min(u, V1))",
        signature: "missing voltage, only at large commands, and the more the larger they are",
        exposed_by: "commands of at least four sizes up to the full supply",
        look_alikes: &["supply_sag", "torque_sat"],
        source: "any text on power electronics: switch drop, limit of the duty cycle",
        facts: Facts {
            starts: Starts::Shares(&[(0, &[1.0, 0.7, 0.5])]),
            told_from: &[ToldFrom {
                other: Other::Effect("torque_sat"),
                record: "a stall with the current logged: a plateau of the current, or of the torque alone",
                measure: Some(
                    "a current sensor together with a known added inertia: a plateau of the current against a sag of the torque",
                ),
            }],
            ..Facts::PLAIN
        },
    };
    const ORDER: u8 = 2;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        VoltageSat {
            limit: units
                .number::<S>(values[0], Quantity::Voltage)
                .max(S::zero()),
        }
    }

    #[inline(always)]
    fn drive(&self, volts: S) -> S {
        volts.min(self.limit).max(-self.limit)
    }
}
