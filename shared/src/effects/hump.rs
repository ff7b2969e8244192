//! Friction that is largest near standstill, and fades with the speed.

use super::chebyshev::Chebyshev;
use crate::scalar::{Mask, Real, Scalar, lanes};

/// `H·e^(−|ω/ωs|^δ)` for `1 ≤ δ ≤ 2`: Tustin's with 1, the Gaussian of Armstrong-Hélouvry with 2.
///
/// Number formats have no power, so it is a series, fitted when the effect is lowered. At rest
/// `1 − |ω/ωs|^δ` is not smooth, and a series in the speed converges slowly; in the [`nearness`] of
/// standstill it is right to 1e-4 of the height, and to 2e-6 for the exponents of the two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hump<S: Scalar> {
    height: S,
    /// Speed at which it is over.
    reach: S,
    per_reach: S::Coefficient,
    /// Of the nearness.
    turn: S,
    /// What is left of one, by the nearness.
    part: Chebyshev<S>,
}

lanes!(Hump {
    height,
    reach,
    per_reach,
    turn,
    part
});

/// Slowest `ωs`, as a part of the base speed: below it the hump is a static friction.
pub(super) const SLOWEST: f64 = 1e-4;

/// It is over where it has fallen to `e` to the minus this, 8e-7.
const DEPTH: f64 = 14.0;

impl<S: Scalar> Hump<S> {
    /// A hump of a height that fades over `speed`, both per unit. The exponent is kept within 1 and 2.
    pub(super) fn new<R: Real>(height: R, speed: R, exponent: R) -> Self {
        let one = R::from_f64(1.0);
        let exponent = exponent.max(one).min(R::from_f64(2.0));
        // |ω/ωs| where it is over.
        let end = (R::from_f64(DEPTH).ln() / exponent).exp();
        let reach = end * speed.max(R::from_f64(SLOWEST));
        let turn = turn(exponent);
        let part = |nearness| {
            let distance = distance(nearness, turn);
            if distance < one {
                // (d·end)^δ; the logarithm of nothing gives nothing again.
                let power = (exponent * (distance * end).ln()).exp();
                (-power).exp()
            } else {
                R::zero()
            }
        };
        let over = if R::zero() < height { reach } else { R::zero() };
        Hump {
            height: S::from_f64(height.to_f64()),
            reach: S::from_f64(over.to_f64()),
            per_reach: S::coefficient((one / reach).to_f64()),
            turn: S::from_f64(turn.to_f64()),
            part: Chebyshev::through(part),
        }
    }

    /// What is left of it at a speed.
    #[inline(always)]
    pub(super) fn at(&self, speed: S) -> S {
        let speed = speed.abs();
        // Most of the time the shaft is faster than that, and nothing has to be computed.
        if !speed.less(self.reach).any() {
            return S::zero();
        }
        let distance = speed.min(self.reach).times(self.per_reach);
        // The series swings about zero near its end.
        let part = self.part.at(nearness(distance, self.turn)).max(S::zero());
        self.height * part
    }
}

/// Distance about which the nearness turns, as a part of the reach: `10^((δ − 1)² − 1)`. Found by trial:
/// for every exponent the error is nearly the least that can be had. Small exponents, which are the least
/// smooth at rest, want a small one.
fn turn<R: Real>(exponent: R) -> R {
    let above = exponent - R::from_f64(1.0);
    let ten = R::from_f64(core::f64::consts::LN_10);
    ((above * above - R::from_f64(1.0)) * ten).exp()
}

/// How near to standstill a speed is, from −1 at the reach to 1 at rest, for a distance within 0 and 1:
/// `2t·(1 − d)/(d + t) − 1`, which spreads the range about standstill by `1 + 1/t`.
#[inline(always)]
fn nearness<S: Scalar>(distance: S, turn: S) -> S {
    let one = S::from_f64(1.0);
    let half = ((one - distance) * turn).part_of(distance + turn);
    half + half - one
}

/// The inverse.
fn distance<R: Real>(nearness: R, turn: R) -> R {
    let one = R::from_f64(1.0);
    let half = (nearness + one) * R::from_f64(0.5);
    (one - half) * turn / (half + turn)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Fixed;

    const EXPONENTS: [f64; 8] = [1.0, 1.02, 1.1, 1.2, 1.35, 1.5, 1.8, 2.0];
    const SPEEDS: [f64; 5] = [0.0, 1e-4, 1e-3, 0.03, 0.9];
    /// Of a height of one.
    const WITHIN: f64 = 1.2e-4;

    /// Furthest from the law over speeds from rest to beyond the reach, dense near rest.
    fn furthest<S: Scalar>(speed: f64, exponent: f64, to_f64: impl Fn(S) -> f64) -> f64 {
        let hump = Hump::<S>::new(1.0, speed, exponent);
        let slow = speed.max(SLOWEST);
        (0..4000)
            .map(|k| 15.0 * slow * (f64::from(k) / 4000.0).powi(3))
            .filter(|at| *at < S::LIMIT)
            .flat_map(|at| [at, -at])
            .map(|at| {
                let law = (-(at.abs() / slow).powf(exponent)).exp();
                (to_f64(hump.at(S::from_f64(at))) - law).abs()
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn is_the_law_at_every_speed_with_every_exponent_in_every_format() {
        for exponent in EXPONENTS {
            for speed in SPEEDS {
                let off = [
                    furthest::<f64>(speed, exponent, |part| part),
                    furthest::<f32>(speed, exponent, f64::from),
                    furthest::<Fixed>(speed, exponent, Fixed::to_f64),
                ];
                assert!(
                    off.iter().all(|off| *off < WITHIN),
                    "exponent {exponent}, speed {speed}: {off:?} of the height off in f64, f32, fixed point"
                );
            }
        }
    }

    #[test]
    fn is_whole_at_rest_over_beyond_its_reach_and_never_pushes() {
        for exponent in EXPONENTS {
            let hump = Hump::<f64>::new(0.2, 0.05, exponent);
            assert!((hump.at(0.0) - 0.2).abs() < 1e-12, "exponent {exponent}");
            assert_eq!(hump.at(hump.reach), 0.0, "exponent {exponent}");
            let short_of_it = hump.at(hump.reach * (1.0 - 1e-9));
            assert!(
                short_of_it < 1e-9,
                "exponent {exponent}: ends at {short_of_it}"
            );
            for k in 0..10_000 {
                let speed = hump.reach * f64::from(k) / 10_000.0;
                assert!(hump.at(speed) >= 0.0, "exponent {exponent} at {speed}");
            }
        }
    }

    #[test]
    fn nothing_is_nothing() {
        assert_eq!(Hump::<f64>::new(0.0, 0.05, 1.5).at(0.0), 0.0);
    }
}
