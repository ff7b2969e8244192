//! A wave along the angle, and its mean over a part of a step.

use super::Shaft;
use crate::scalar::curves::polynomial;
use crate::scalar::{Scalar, lanes};

/// `A·cos(kθ) + B·sin(kθ)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Harmonic<S: Scalar> {
    order: S::Coefficient,
    /// Length of one wave, turns.
    wave: S,
    cosine: S,
    sine: S,
}

lanes!(Harmonic {
    order,
    wave,
    cosine,
    sine
});

/// `sin(πx)/(πx)` in powers of `x²`, highest first. What is left out is below 3e-7 up to its first
/// zero at `x = 1`.
const SINC: [f64; 8] = [
    -6.975_873_661_656_377e-6,
    1.484_287_930_310_709_2e-4,
    -2.346_081_035_455_823_6e-3,
    2.614_784_781_765_479_8e-2,
    -1.907_518_241_220_842e-1,
    8.117_424_252_833_535e-1,
    -1.644_934_066_848_226_4,
    1.0,
];

impl<S: Scalar> Harmonic<S> {
    /// Of `order` waves a revolution; orders are whole, for a full turn must change nothing.
    pub(super) fn new(cosine: S, sine: S, order: f64) -> Self {
        let order = libm::round(order).max(1.0);
        Harmonic {
            order: S::coefficient(order),
            wave: S::from_f64(1.0 / order),
            cosine,
            sine,
        }
    }

    /// Its value at a position within the revolution, in turns.
    #[inline(always)]
    pub(super) fn at(&self, turns: S) -> S {
        let (sine, cosine) = turns.times(self.order).sin_cos_turns();
        self.cosine * cosine + self.sine * sine
    }

    /// Its mean over the travel of a part: the value at the middle, less as the travel nears a whole
    /// wave, and nothing beyond that, where the waves cancel.
    #[inline(always)]
    pub(super) fn mean(&self, shaft: &Shaft<S>) -> S {
        let waves = shaft.travel.abs().min(self.wave).times(self.order);
        let square = waves * waves;
        self.at(shaft.turns) * polynomial(&SINC, square)
    }
}
