//! Friction that falls with the speed as a quotient.

use super::hump::SLOWEST;
use crate::scalar::{Mask, Real, Scalar, lanes};

/// `H/(1 + (ω/ωs)²)` (Hess, Soom, *J. Tribology* 112, 1990, 147): near standstill like a Gaussian, far from it a tail that falls
/// as the square of the speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quotient<S: Scalar> {
    height: S,
    /// `ωs`.
    speed: S,
    per_speed: S::Coefficient,
}

lanes!(Quotient {
    height,
    speed,
    per_speed
});

impl<S: Scalar> Quotient<S> {
    /// Of a height that is halved at `speed`, both per unit.
    pub(super) fn new<R: Real>(height: R, speed: R) -> Self {
        let speed = speed.max(R::from_f64(SLOWEST));
        Quotient {
            height: S::from_f64(height.to_f64()),
            speed: S::from_f64(speed.to_f64()),
            per_speed: S::coefficient((R::from_f64(1.0) / speed).to_f64()),
        }
    }

    /// What is left of it at a speed.
    #[inline(always)]
    pub(super) fn at(&self, speed: S) -> S {
        // Nearly always it is none at all.
        if !S::zero().less(self.height.abs()).any() {
            return S::zero();
        }
        let one = S::from_f64(1.0);
        let speed = speed.abs();
        // The smaller over the larger of the two speeds, so that no square leaves the number format.
        let slow = speed.min(self.speed).times(self.per_speed);
        let fast = self.speed.part_of(speed.max(self.speed));
        let (slow, fast) = (slow * slow, fast * fast);
        let part = S::select(
            speed.less(self.speed),
            one.part_of(one + slow),
            fast.part_of(one + fast),
        );
        self.height * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Fixed;

    const SPEEDS: [f64; 4] = [1e-4, 1e-3, 0.03, 0.9];
    /// Of a height of one. Fixed point holds 1/ωs in so many digits.
    const WITHIN: f64 = 1e-3;

    fn furthest<S: Scalar>(speed: f64, to_f64: impl Fn(S) -> f64) -> f64 {
        let quotient = Quotient::<S>::new(1.0, speed);
        (0..4000)
            .map(|k| 1.2 * (f64::from(k) / 4000.0).powi(4))
            .flat_map(|at| [at, -at])
            .map(|at| {
                let law = 1.0 / (1.0 + (at / speed).powi(2));
                (to_f64(quotient.at(S::from_f64(at))) - law).abs()
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn is_the_law_at_every_speed_in_every_format() {
        for speed in SPEEDS {
            let off = [
                furthest::<f64>(speed, |part| part),
                furthest::<f32>(speed, f64::from),
                furthest::<Fixed>(speed, Fixed::to_f64),
            ];
            assert!(
                off.iter().all(|off| *off < WITHIN),
                "speed {speed}: {off:?} of the height off in f64, f32, fixed point"
            );
        }
    }

    #[test]
    fn nothing_is_nothing() {
        assert_eq!(Quotient::<f64>::new(0.0, 0.05).at(0.0), 0.0);
    }
}
