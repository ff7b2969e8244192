//! Stribeck friction: static friction above the sliding one.

use super::decay::{REACH, decay};
use super::{Budget, Description, Effect, Needs, Parameter, Place, Shaft};
use crate::scalar::{Mask, Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// Sliding friction `Tc` that rises to `Tc + Ts` as the speed falls below about `ws`. The rise is
/// exponential (Tustin, exponent 1), Gaussian (Armstrong-Hélouvry, exponent 2), or a mixture of the
/// two in proportion to where the exponent lies between.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck<S: Scalar> {
    sliding: S,
    excess: S,
    /// Speeds at which the exponential and the Gaussian are over; zero for one that has no part.
    reach: [S; 2],
    /// One over four, and over two, Stribeck speeds.
    per_speed: [S::Coefficient; 2],
    exponential: S,
    gaussian: S,
}

/// Slowest Stribeck speed, as a part of the base speed: below it the hump is a static friction.
const SLOWEST: f64 = 1e-4;

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
        let over = |share: f64, speeds: f64| {
            let speeds = if share > 0.0 { speeds } else { 0.0 };
            S::from_f64(speeds * speed)
        };
        Stribeck {
            sliding: units.number(values[0], Quantity::Torque),
            excess: units.number(values[1], Quantity::Torque),
            reach: [
                over(1.0 - gaussian, 4.0 * REACH),
                over(gaussian, 2.0 * libm::sqrt(REACH)),
            ],
            per_speed: [4.0, 2.0].map(|n| S::coefficient(1.0 / (n * speed))),
            exponential: S::from_f64(1.0 - gaussian),
            gaussian: S::from_f64(gaussian),
        }
    }

    #[inline]
    fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        let hump = shaft.mean_over_speed(|speed| {
            let speed = speed.abs();
            // Most of the time the shaft is faster than that, and nothing has to be computed.
            let near = |k: usize| {
                let near = speed.less(self.reach[k]).any();
                near.then(|| speed.min(self.reach[k]).times(self.per_speed[k]))
            };
            let exponential = near(0).map_or(S::zero(), |x| self.exponential * decay(x));
            let gaussian = near(1).map_or(S::zero(), |x| self.gaussian * decay(x * x));
            exponential + gaussian
        });
        Budget {
            moving: self.sliding + self.excess * hump,
            holding: self.sliding + self.excess,
            bias: S::zero(),
        }
    }
}
