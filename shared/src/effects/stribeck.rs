//! Stribeck friction: static friction above the sliding one.

use super::hump::Hump;
use super::{Budget, Description, Effect, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// Sliding friction `Tc` that rises to `Tc + Ts` as the speed falls below about `ws`. The rise is
/// exponential (Tustin, exponent 1), Gaussian (Armstrong-Hélouvry, exponent 2), or a mixture of the
/// two in proportion to where the exponent lies between.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck<S: Scalar> {
    sliding: S,
    holding: S,
    exponential: Hump<S>,
    gaussian: Hump<S>,
}

impl<S: Scalar> Effect<S> for Stribeck<S> {
    const DESCRIPTION: Description = Description {
        name: "stribeck",
        place: Place::Friction,
        title: "Stribeck friction (larger near standstill)",
        parameters: &[
            Parameter::amplitude("torque", Quantity::Torque, (0.0, 0.5), 0.03),
            Parameter::amplitude("excess_torque", Quantity::Torque, (0.0, 0.5), 0.03),
            Parameter::shape("speed", Quantity::Speed, (0.001, 0.3), 0.03),
            Parameter::shape("exponent", Quantity::Ratio, (1.0, 2.0), 2.0),
        ],
        equation: "T = (Tc + Ts*((2-d)*exp(-|w|/ws) + (d-1)*exp(-(w/ws)^2)))*sgn(w); |T| <= Tc + Ts at rest",
        signature: "hump of the residual torque near zero speed, of both signs; late starts, sudden stops",
        exposed_by: "a slow triangle of small amplitude, or creeping both ways",
        look_alikes: &["coulomb", "lugre", "dead_zone"],
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994, eq. 2",
    };
    const NEEDS: Needs = Needs {
        mean: true,
        friction: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let excess = units.lower(values[1], Quantity::Torque).to_f64();
        let speed = units.lower(values[2], Quantity::Speed).to_f64();
        let gaussian = (values[3].to_f64() - 1.0).clamp(0.0, 1.0);
        Stribeck {
            sliding: units.number(values[0], Quantity::Torque),
            holding: units.number(values[0] + values[1], Quantity::Torque),
            exponential: Hump::exponential(excess * (1.0 - gaussian), speed),
            gaussian: Hump::gaussian(excess * gaussian, speed),
        }
    }

    #[inline]
    fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        let hump =
            shaft.mean_over_speed(|speed| self.exponential.at(speed) + self.gaussian.at(speed));
        Budget {
            moving: self.sliding + hump,
            holding: self.holding,
            bias: S::zero(),
        }
    }
}
