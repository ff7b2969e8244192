//! Voltage drop of the brushes.

use super::{
    Brush, Description, Effect, Evidence, Facts, Needs, Other, Parameter, Place, Starts, ToldFrom,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// A voltage against the current: proportional up to the knee, constant beyond. Its form is blended into a hyperbolic tangent.
#[derive(Clone, Copy, Debug)]
pub struct BrushDrop<S> {
    brush: Brush<S>,
}

lanes!(BrushDrop { brush });

impl<S: Scalar> Effect<S> for BrushDrop<S> {
    const DESCRIPTION: Description = Description {
        name: "brush_drop",
        place: Place::Drive,
        title: "voltage drop of the brushes",
        parameters: &[
            Parameter::amplitude("voltage", Quantity::Voltage, (0.0, 0.5), 0.04),
            Parameter::shape("knee", Quantity::Voltage, (0.001, 0.1), 0.01),
            // Nothing is sharper than a sharp knee.
            Parameter {
                range: (0.0, 1.5),
                ..Parameter::form("form")
            },
        ],
        equation: "v = u - Vb*((1 - f)*max(-1, min(R*i/V0, 1)) + f*tanh(R*i/V0))",
        signature: "residual voltage changes sign with the current and does not grow with it",
        exposed_by: "braking and driving at the same speed; coasting tells it from friction",
        look_alikes: &["coulomb", "dead_zone"],
        source: "Modelica Standard Library, Machines.Losses.DCMachines.Brush; Hughes, Drury, Electric Motors and Drives, 2019 (rounded)",
        facts: Facts {
            starts: Starts::Shares(&[(1, &[1.0, 0.2])]),
            evidence: Evidence::ChangesSign,
            told_from: &[ToldFrom {
                other: Other::Effect("dead_zone"),
                record: "the same commands on two supply voltages: a dead time scales with the supply, brushes do not",
                measure: Some(
                    "the same at two supply voltages: what the stage loses grows with the supply, what the brushes drop does not",
                ),
            }],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs::VOLTS_BY_CURRENT;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        BrushDrop {
            brush: Brush {
                drop: units.number(values[0], Quantity::Voltage),
                knee: units.number(values[1], Quantity::Voltage),
                form: units.number(values[2], Quantity::Ratio),
                ..Brush::default()
            },
        }
    }

    #[inline(always)]
    fn brush(&self) -> Brush<S> {
        self.brush
    }
}
