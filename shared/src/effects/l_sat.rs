//! Saturation of the armature inductance.

use super::{Description, Effect, Facts, Needs, Parameter, Place, Shaft, Winding};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Incremental inductance `L/(1 + k·c²)`: the simplest even form that stays positive.
#[derive(Clone, Copy, Debug)]
pub struct LSat<S: Scalar> {
    falloff: S::Coefficient,
}

lanes!(LSat { falloff });

impl<S: Scalar> Effect<S> for LSat<S> {
    const DESCRIPTION: Description = Description {
        name: "l_sat",
        place: Place::Winding,
        title: "saturation of the inductance",
        parameters: &[
            Parameter::amplitude("falloff", Quantity::PerSquareVolt, (0.0, 4.0), 1.0)
                .widening_to(40.0),
        ],
        equation: "L = L0/(1 + k*(R*i)^2)",
        signature: "current rises faster than the model's when it is large; only at jumps of the voltage",
        exposed_by: "reversals at full voltage against small steps, sampled faster than L/R",
        look_alikes: &["torque_sat", "delay"],
        source: "Krause, Wasynczuk, Sudhoff, Analysis of Electric Machinery, 2002 (saturation)",
        facts: Facts {
            series_parallel: false,
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        current: true,
        winding: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        LSat {
            falloff: units.multiplier::<S>(values[0], Quantity::PerSquareVolt),
        }
    }

    #[inline(always)]
    fn winding(&self, _volts: S, shaft: &Shaft<S>, _memory: S) -> Winding<S> {
        let square = shaft.mean_over_current(
            #[inline(always)]
            |current| current * current,
        );
        Winding {
            rate: square.times(self.falloff),
            ..Winding::default()
        }
    }
}
