//! Magnetic saturation of the torque.

use super::{Description, Effect, Facts, Needs, Parameter, Place, Shaft};
use crate::scalar::curves::polynomial;
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Torque `Is·tanh(c/Is)` of a current `c`, with `Is = 1/√(3·k3)`: a bounded law whose series begins
/// with the cubic one, `c − k3·c³`. The back-EMF keeps its constant.
#[derive(Clone, Copy, Debug)]
pub struct TorqueSat<S: Scalar> {
    /// `3·k3`.
    square: S::Coefficient,
}

lanes!(TorqueSat { square });

/// `tanh(x)/x` as a quotient of polynomials in `x²`, the fourth approximant of its continued
/// fraction (Lambert): off by less than 2e-6 up to `x = 2.45`, highest powers first.
const ABOVE: [f64; 3] = [21.0 / 10_395.0, 1_260.0 / 10_395.0, 1.0];
const BELOW: [f64; 4] = [1.0 / 10_395.0, 210.0 / 10_395.0, 4_725.0 / 10_395.0, 1.0];

impl<S: Scalar> Effect<S> for TorqueSat<S> {
    const DESCRIPTION: Description = Description {
        name: "torque_sat",
        place: Place::Winding,
        title: "magnetic saturation of the torque",
        parameters: &[
            Parameter::amplitude("cubic", Quantity::PerSquareVolt, (0.0, 0.4), 0.08)
                .widening_to(4.0),
        ],
        equation: "Tm = Is*tanh(R*i/Is), Is = 1/sqrt(3*k3)",
        signature: "torque falls short at large currents, as their cube",
        exposed_by: "reversals at full voltage, where the current is largest",
        look_alikes: &["supply_sag", "load_friction", "l_sat"],
        source: "Krause, Wasynczuk, Sudhoff, Analysis of Electric Machinery, 2002 (armature reaction)",
        facts: Facts::PLAIN,
    };
    const NEEDS: Needs = Needs {
        mean: true,
        current: true,
        lost_torque: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let square = values[0] * R::from_f64(3.0);
        TorqueSat {
            square: units.multiplier::<S>(square, Quantity::PerSquareVolt),
        }
    }

    #[inline(always)]
    fn lost_torque(&self, shaft: &Shaft<S>, _memory: S) -> S {
        shaft.mean_over_current(
            #[inline(always)]
            |current| {
                let y = (current * current).times(self.square);
                let share = polynomial(&ABOVE, y).part_of(polynomial(&BELOW, y));
                current - current * share
            },
        )
    }
}
