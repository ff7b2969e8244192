//! Magnetic saturation of the torque.

use super::tangent::tanh_share;
use super::{Description, Effect, Facts, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Torque `Is·tanh(c/Is)` of a current `c`, with `Is = 1/√(3·k3)`: a bounded law whose series begins
/// with the cubic one, `c − k3·c³`. The back-EMF keeps its constant.
///
/// Its form is blended into `c/(1 + k3·c²)`, whose series begins alike and which falls again where the armature's
/// field has used up the poles'.
#[derive(Clone, Copy, Debug)]
pub struct TorqueSat<S: Scalar> {
    /// `3·k3`.
    square: S::Coefficient,
    form: S::Coefficient,
}

lanes!(TorqueSat { square, form });

impl<S: Scalar> Effect<S> for TorqueSat<S> {
    const DESCRIPTION: Description = Description {
        name: "torque_sat",
        place: Place::Winding,
        title: "magnetic saturation of the torque",
        parameters: &[
            Parameter::amplitude("cubic", Quantity::PerSquareVolt, (0.0, 0.4), 0.08)
                .widening_to(4.0),
            Parameter::form("form"),
        ],
        equation: "Tm = (1 - f)*Is*tanh(R*i/Is) + f*R*i/(1 + k3*(R*i)^2), Is = 1/sqrt(3*k3)",
        signature: "torque falls short at large currents, as their cube",
        exposed_by: "reversals at full voltage, where the current is largest",
        look_alikes: &["supply_sag", "load_friction", "l_sat"],
        source: "Krause, Wasynczuk, Sudhoff, Analysis of Electric Machinery, 2002 (armature reaction); Fitzgerald, Kingsley, Umans, Electric Machinery, 2003 (magnetising curves)",
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
            form: units.multiplier::<S>(values[1], Quantity::Ratio),
        }
    }

    #[inline(always)]
    fn lost_torque(&self, shaft: &Shaft<S>, _memory: S) -> S {
        let (one, third) = (S::from_f64(1.0), S::coefficient(1.0 / 3.0));
        shaft.mean_over_current(
            #[inline(always)]
            |current| {
                let y = (current * current).times(self.square);
                let share = tanh_share(y);
                let quotient = one.part_of(one + y.times(third));
                current - current * (share + (quotient - share).times(self.form))
            },
        )
    }
}
