//! Stribeck friction: static friction above the sliding one.

use super::{Budget, Description, Effect, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// Sliding friction `Tc` that rises to `Tc + Ts` as the speed falls below about `ws`.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck<S: Scalar> {
    sliding: S,
    excess: S,
    reach: S,
    per_speed: S::Coefficient,
}

/// Slowest Stribeck speed, as a part of the base speed: below it the hump is a static friction.
const SLOWEST: f64 = 1e-4;

/// Stribeck speeds after which the hump is over: a larger exponent would not fit fixed point.
const REACH: f64 = 7.0;

impl<S: Scalar> Effect<S> for Stribeck<S> {
    const DESCRIPTION: Description = Description {
        name: "stribeck",
        place: Place::Friction,
        title: "Stribeck friction (larger near standstill)",
        parameters: &[
            Parameter {
                name: "torque",
                quantity: Quantity::Torque,
                range: (0.0, 0.5),
                typical: 0.03,
                amplitude: true,
            },
            Parameter {
                name: "excess_torque",
                quantity: Quantity::Torque,
                range: (0.0, 0.5),
                typical: 0.03,
                amplitude: true,
            },
            Parameter {
                name: "speed",
                quantity: Quantity::Speed,
                range: (0.001, 0.3),
                typical: 0.02,
                amplitude: false,
            },
        ],
        equation: "T = (Tc + Ts*exp(-|w|/ws))*sgn(w); |T| <= Tc + Ts at rest",
        signature: "hump of the residual torque near zero speed, of both signs; late starts, sudden stops",
        exposed_by: "a slow triangle of small amplitude, or creeping both ways",
        look_alikes: &["coulomb", "lugre", "dead_zone"],
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994, eq. 2",
    };
    const BENDS: bool = true;
    const FRICTION: bool = true;

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let speed = units
            .lower(values[2], Quantity::Speed)
            .max(R::from_f64(SLOWEST));
        Stribeck {
            sliding: S::from_f64(units.lower(values[0], Quantity::Torque).to_f64()),
            excess: S::from_f64(units.lower(values[1], Quantity::Torque).to_f64()),
            reach: S::from_f64(REACH * speed.to_f64()),
            per_speed: S::coefficient((R::from_f64(1.0) / speed).to_f64()),
        }
    }

    #[inline]
    fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        let near = shaft.speed.abs().min(self.reach).times(self.per_speed);
        Budget {
            moving: self.sliding + self.excess * (-near).exp_decay(),
            holding: self.sliding + self.excess,
        }
    }
}
