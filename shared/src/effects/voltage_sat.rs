//! The power stage clips.

use super::{Description, Effect, Facts, Other, Parameter, Place, Starts, ToldFrom};
use crate::scalar::curves::polynomial;
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Commands beyond `±V1` give `±V1`. There is nothing to see where no command reaches the limit.
///
/// Its form is blended into a stage that rounds before it clips, `u/(1 + (u/V1)⁶)^(1/6)`.
#[derive(Clone, Copy, Debug)]
pub struct VoltageSat<S: Scalar> {
    limit: S,
    form: S::Coefficient,
}

lanes!(VoltageSat { limit, form });

/// `(1 + z)^(−1/6) − 1` for `0 ≤ z ≤ 1`, highest powers first: the polynomial through Chebyshev's points, off by less than 1e-7.
const ROUNDED: [f64; 8] = [
    -0.002_320_256_283_195,
    0.012_050_195_672_921,
    -0.029_606_024_151_942,
    0.049_134_018_103_030,
    -0.068_751_469_257_697,
    0.097_051_075_989_627,
    -0.166_658_793_443_527,
    0.0,
];

impl<S: Scalar> Effect<S> for VoltageSat<S> {
    const DESCRIPTION: Description = Description {
        name: "voltage_sat",
        place: Place::Drive,
        title: "clipped voltage of the power stage",
        parameters: &[
            Parameter {
                neutral: Some(1.0),
                ..Parameter::shape("limit", Quantity::Voltage, (0.3, 1.0), 0.85)
            },
            Parameter::form("form"),
        ],
        equation: "v = (1 - f)*max(-V1, min(u, V1)) + f*u/(1 + (u/V1)^6)^(1/6)",
        signature: "missing voltage, only at large commands, and the more the larger they are",
        exposed_by: "commands of at least four sizes up to the full supply",
        look_alikes: &["supply_sag", "torque_sat"],
        source: "any text on power electronics: switch drop, limit of the duty cycle; Rapp, Effects of HPA nonlinearity, 1991 (rounded)",
        facts: Facts {
            starts: Starts::Shares(&[(0, &[1.0, 0.7, 0.5])]),
            both_forms: true,
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
            form: units.multiplier::<S>(values[1], Quantity::Ratio),
        }
    }

    #[inline(always)]
    fn drive(&self, volts: S) -> S {
        let clipped = volts.min(self.limit).max(-self.limit);
        let size = volts.abs();
        // The rounding is the same so many times below the limit as above it.
        let near = size.min(self.limit).part_of(size.max(self.limit));
        let square = near * near;
        let rounded = polynomial(&ROUNDED, square * square * square);
        clipped + (clipped * rounded).times(self.form)
    }
}
