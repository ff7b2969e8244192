//! Saturation of the armature inductance.

use super::{Description, Effect, Facts, Needs, Parameter, Place, Shaft, Winding};
use crate::scalar::curves::polynomial;
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Incremental inductance `L/(1 + k·c²)`: the simplest even form that stays positive.
///
/// Its form is blended into `L/cosh²(√k·c)`, of a flux linkage `tanh`, whose series begins alike.
#[derive(Clone, Copy, Debug)]
pub struct LSat<S: Scalar> {
    falloff: S::Coefficient,
    form: S::Coefficient,
}

lanes!(LSat { falloff, form });

/// `sinh²(√y)/y − 1` in powers of `y`, highest first: Taylor's series, off by less than 3e-6 of `sinh²` up to [`SATURATED`].
const SINH_SQUARED: [f64; 9] = [
    2.047_465e-11,
    1.566_140e-9,
    9.396_837e-8,
    4.275_561e-6,
    2.0 / 14_175.0,
    1.0 / 315.0,
    2.0 / 45.0,
    1.0 / 3.0,
    0.0,
];

/// `k·c²` from which on the iron is saturated and the inductance is that of the air, a fiftieth; less where a number format does
/// not reach as far.
const SATURATED: f64 = 7.0;

impl<S: Scalar> Effect<S> for LSat<S> {
    const DESCRIPTION: Description = Description {
        name: "l_sat",
        place: Place::Winding,
        title: "saturation of the inductance",
        parameters: &[
            Parameter::amplitude("falloff", Quantity::PerSquareVolt, (0.0, 4.0), 1.0)
                .widening_to(40.0),
            Parameter::form("form"),
        ],
        equation: "L = L0/(1 + (1 - f)*k*(R*i)^2 + f*sinh(sqrt(k)*R*i)^2)",
        signature: "current rises faster than the model's when it is large; only at jumps of the voltage",
        exposed_by: "reversals at full voltage against small steps, sampled faster than L/R",
        look_alikes: &["torque_sat", "delay"],
        source: "Krause, Wasynczuk, Sudhoff, Analysis of Electric Machinery, 2002 (saturation); Jiles, Introduction to Magnetism and Magnetic Materials, 2015 (hyperbolic flux)",
        facts: Facts {
            series_parallel: false,
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs::VOLTS_BY_CURRENT;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        LSat {
            falloff: units.multiplier::<S>(values[0], Quantity::PerSquareVolt),
            form: units.multiplier::<S>(values[1], Quantity::Ratio),
        }
    }

    #[inline(always)]
    fn winding(&self, shaft: &Shaft<S>, _memory: S) -> Winding<S> {
        let square = shaft.mean_over_current(
            #[inline(always)]
            |current| current * current,
        );
        let most = S::from_f64(SATURATED.min(S::LIMIT / 4.0));
        let steeper = shaft.mean_over_current(
            #[inline(always)]
            |current| {
                let y = (current * current).times(self.falloff);
                let kept = y.min(most);
                kept * polynomial(&SINH_SQUARED, kept) - (y - kept)
            },
        );
        let rate = square.times(self.falloff) + steeper.times(self.form);
        Winding {
            // Far beyond the textbook's form on the other side there would be more inductance than unsaturated.
            rate: rate.max(S::zero()),
            ..Winding::default()
        }
    }
}
