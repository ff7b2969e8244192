//! Stribeck friction: static friction above the sliding one.

use super::coulomb::ELECTRICAL;
use super::hump::Hump;
use super::quotient::Quotient;
use super::{
    AtSpeed, Budget, Contained, Description, Effect, Evidence, Facts, Needs, Parameter, Place,
    Shaft, Starts, Value,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// Sliding friction `Tc` that rises to `Tc + Ts` as the speed falls below about `ws`. The exponent is
/// the shape of the rise: exponential with 1 (Tustin), Gaussian with 2 (Armstrong-Hélouvry).
///
/// Its form is blended into `Ts/(1 + (ω/ws)²)` (Hess, Soom), which falls far more slowly.
#[derive(Clone, Copy, Debug)]
pub struct Stribeck<S: Scalar> {
    sliding: S,
    holding: S,
    /// The part of the excess that falls exponentially, and the one that falls as a quotient.
    excess: Hump<S>,
    slow_excess: Quotient<S>,
}

lanes!(Stribeck {
    sliding,
    holding,
    excess,
    slow_excess
});

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
            Parameter::form("form"),
        ],
        equation: "T = (Tc + Ts*((1 - f)*exp(-|w/ws|^d) + f/(1 + (w/ws)^2)))*sgn(w); |T| <= Tc + Ts at rest",
        signature: "hump of the residual torque near zero speed, of both signs; late starts, sudden stops",
        exposed_by: "a slow triangle of small amplitude, or creeping both ways",
        look_alikes: &["coulomb", "lugre", "dead_zone"],
        source: "Armstrong-Helouvry, Dupont, Canudas de Wit, Automatica 30(7), 1994, eq. 2; Hess, Soom, J. Tribology 112, 1990 (quotient)",
        facts: Facts {
            contains: &[Contained {
                name: "coulomb",
                values: &[Value::Own(0)],
                at_rest: &[(1, 0.0)],
                whole: true,
            }],
            starts: Starts::Shares(&[(2, &[1.0, 4.0])]),
            evidence: Evidence::ChangesSign,
            at_speed: AtSpeed::Sliding {
                mean_of: &[0],
                without: Some("what is larger near standstill is left out"),
            },
            told_from: &[ELECTRICAL],
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        friction: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let excess = units.lower(values[1], Quantity::Torque);
        let speed = units.lower(values[2], Quantity::Speed);
        let slow = excess * values[4];
        Stribeck {
            sliding: units.number(values[0], Quantity::Torque),
            holding: units.number(values[0] + values[1], Quantity::Torque),
            excess: Hump::new(excess - slow, speed, values[3]),
            slow_excess: Quotient::new(slow, speed),
        }
    }

    #[inline(always)]
    fn friction(&self, shaft: &Shaft<S>) -> Budget<S> {
        let excess = shaft.mean_over_speed(
            #[inline(always)]
            |speed| self.excess.at(speed) + self.slow_excess.at(speed),
        );
        Budget {
            // A form beyond the two may leave less than nothing.
            moving: (self.sliding + excess).max(S::zero()),
            holding: self.holding,
            bias: S::zero(),
        }
    }
}
