//! Stribeck friction: static friction above the sliding one.

use super::{Budget, Description, Effect, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// Sliding friction `Tc` that rises to `Tc + Ts` as the speed falls below about `ws`. The rise is
/// exponential (Tustin, exponent 1), Gaussian (Armstrong-Hélouvry, exponent 2), or a mixture of the
/// two in proportion to where the exponent lies between.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck<S: Scalar> {
    sliding: S,
    excess: S,
    /// Speed at which the hump is over.
    reach: S,
    per_speed: S::Coefficient,
    exponential: S,
    gaussian: S,
}

/// Slowest Stribeck speed, as a part of the base speed: below it the hump is a static friction.
const SLOWEST: f64 = 1e-4;

/// Stribeck speeds after which the hump is over: `e` to the minus this is as good as nothing.
const REACH: f64 = 7.0;

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
        let speed = units
            .lower(values[2], Quantity::Speed)
            .max(R::from_f64(SLOWEST))
            .to_f64();
        let gaussian = (values[3].to_f64() - 1.0).clamp(0.0, 1.0);
        Stribeck {
            sliding: units.number(values[0], Quantity::Torque),
            excess: units.number(values[1], Quantity::Torque),
            reach: S::from_f64(REACH * speed),
            per_speed: S::coefficient(1.0 / speed),
            exponential: S::from_f64(1.0 - gaussian),
            gaussian: S::from_f64(gaussian),
        }
    }

    #[inline]
    fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        // The square reaches as far as the magnitude: beyond, fixed point could not hold it.
        let limit = S::from_f64(libm::sqrt(REACH));
        let hump = shaft.mean_over_speed(|speed| {
            let near = speed.abs().min(self.reach).times(self.per_speed);
            let close = near.min(limit);
            self.exponential * (-near).exp_decay() + self.gaussian * (-(close * close)).exp_decay()
        });
        Budget {
            moving: self.sliding + self.excess * hump,
            holding: self.sliding + self.excess,
            bias: S::zero(),
        }
    }
}
