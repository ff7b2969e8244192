//! Friction that is largest near standstill, and fades with the speed.

use super::decay::{REACH, decay};
use crate::scalar::{Mask, Scalar};

/// `H·e^(−|ω|/ωs)` (Tustin) or `H·e^(−(ω/ωs)²)` (Armstrong-Hélouvry).
#[derive(Clone, Copy, Debug)]
pub(super) struct Hump<S: Scalar> {
    height: S,
    /// Speed at which it is over.
    reach: S,
    /// Quarter of the exponent, or the root of that, by speed.
    per_speed: S::Coefficient,
    gaussian: bool,
}

/// Slowest `ωs`, as a part of the base speed: below it the hump is a static friction.
const SLOWEST: f64 = 1e-4;

impl<S: Scalar> Hump<S> {
    /// A Tustin hump of a height that fades over `speed`, both per unit.
    pub(super) fn exponential(height: f64, speed: f64) -> Self {
        Self::new(height, 4.0 * speed.max(SLOWEST), REACH, false)
    }

    /// A Gaussian hump of a height that fades over `speed`, both per unit.
    pub(super) fn gaussian(height: f64, speed: f64) -> Self {
        Self::new(height, 2.0 * speed.max(SLOWEST), libm::sqrt(REACH), true)
    }

    fn new(height: f64, speed: f64, reach: f64, gaussian: bool) -> Self {
        let reach = if height > 0.0 { reach * speed } else { 0.0 };
        Hump {
            height: S::from_f64(height),
            reach: S::from_f64(reach),
            per_speed: S::coefficient(1.0 / speed),
            gaussian,
        }
    }

    /// What is left of it at a speed.
    #[inline]
    pub(super) fn at(&self, speed: S) -> S {
        let speed = speed.abs();
        // Most of the time the shaft is faster than that, and nothing has to be computed.
        if !speed.less(self.reach).any() {
            return S::zero();
        }
        let near = speed.min(self.reach).times(self.per_speed);
        let quarter = if self.gaussian { near * near } else { near };
        self.height * decay(quarter)
    }
}
