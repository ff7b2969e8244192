//! What a term makes of the speed.

use super::{EXPONENTS, SCALES};

/// A term's dependence on the speed. Powers are of the speed as a part of `reference`, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// None.
    One,
    /// Direction of the motion.
    Sign,
    /// `w/reference`.
    Plain {
        /// Speed at which it is one, rad/s.
        reference: f64,
    },
    /// `|w/reference|^exponent`, with the motion's sign where `odd`.
    Power {
        /// Power.
        exponent: f64,
        /// Whether it has a sign.
        odd: bool,
        /// Where its size is one.
        reference: f64,
    },
    /// `exp(-|w|/scale)`, with the motion's sign where `odd`.
    Decay {
        /// Speed at which it is down to 1/e, rad/s.
        scale: f64,
        /// Whether it has the motion's sign.
        odd: bool,
    },
    /// `(|w|/scale)^exponent*exp(-|w|/scale)`, with the motion's sign.
    Hump {
        /// Power.
        exponent: f64,
        /// Speed by which it is greatest, where the power is one, rad/s.
        scale: f64,
    },
    /// `(w/scale)/(1 + (w/scale)^2)`, as of eddy currents in a brake (Wouterse, *IEE Proc. B* 138, 153, 1991).
    Eddy {
        /// Speed at which it is greatest, rad/s.
        scale: f64,
    },
    /// `(w/scale)/(1 + |w|/scale)`.
    Saturating {
        /// Speed at which it bends, rad/s.
        scale: f64,
    },
    /// `(w/scale)*(|w|/scale)/(1 + |w|/scale)`: what a saturating function lacks of a linear one, as of a back-EMF that saturates.
    Bending {
        /// Speed at which it bends, rad/s.
        scale: f64,
    },
    /// `tanh(w/scale)`.
    Tanh {
        /// Speed at which it bends, rad/s.
        scale: f64,
    },
    /// `(max(±w, 0)/reference)^exponent`.
    OneSided {
        /// Power.
        exponent: f64,
        /// Whether it acts forward.
        forward: bool,
        /// Speed at which it is one, rad/s.
        reference: f64,
    },
    /// Direction of the motion, where it is faster than `threshold`.
    Above {
        /// Speed from which it acts, rad/s.
        threshold: f64,
    },
    /// By how much it is faster than `threshold`, as a part of that, with the motion's sign.
    Beyond {
        /// Speed from which it acts, rad/s.
        threshold: f64,
    },
}

impl Speed {
    /// At a speed, rad/s.
    pub fn at(self, w: f64) -> f64 {
        let size = w.abs();
        let sign = if w == 0.0 { 0.0 } else { w.signum() };
        let signed = |odd: bool| if odd { sign } else { 1.0 };
        match self {
            Speed::One => 1.0,
            Speed::Sign => sign,
            Speed::Plain { reference } => w / reference,
            Speed::Power {
                exponent,
                odd,
                reference,
            } => signed(odd) * libm::pow(size / reference, exponent),
            Speed::Decay { scale, odd } => signed(odd) * libm::exp(-size / scale),
            Speed::Hump { exponent, scale } => {
                sign * libm::pow(size / scale, exponent) * libm::exp(-size / scale)
            }
            Speed::Eddy { scale } => (w / scale) / (1.0 + (w / scale) * (w / scale)),
            Speed::Saturating { scale } => w / (scale + size),
            Speed::Bending { scale } => w / scale * size / (scale + size),
            Speed::Tanh { scale } => libm::tanh(w / scale),
            Speed::OneSided {
                exponent,
                forward,
                reference,
            } => {
                let ahead = if forward { w } else { -w };
                libm::pow(ahead.max(0.0) / reference, exponent)
            }
            Speed::Above { threshold } => {
                if size > threshold {
                    sign
                } else {
                    0.0
                }
            }
            Speed::Beyond { threshold } => sign * (size / threshold - 1.0).max(0.0),
        }
    }

    /// The same but for a part that depends on the speed itself, of which every motor has its own.
    pub(super) fn beside_linear(self) -> Self {
        match self {
            Speed::Bending { scale } => Speed::Saturating { scale },
            other => other,
        }
    }

    /// Its numbers, each with its range.
    pub(super) fn shapes(&mut self) -> impl Iterator<Item = (&mut f64, (f64, f64))> {
        let (exponent, scale) = match self {
            Speed::Power { exponent, .. } | Speed::OneSided { exponent, .. } => {
                (Some(exponent), None)
            }
            Speed::Hump { exponent, scale } => (Some(exponent), Some(scale)),
            Speed::Decay { scale, .. }
            | Speed::Eddy { scale }
            | Speed::Saturating { scale }
            | Speed::Bending { scale }
            | Speed::Tanh { scale }
            | Speed::Above { threshold: scale }
            | Speed::Beyond { threshold: scale } => (None, Some(scale)),
            Speed::One | Speed::Sign | Speed::Plain { .. } => (None, None),
        };
        let scale = scale.map(|scale| {
            let range = (SCALES.0 * *scale, SCALES.1 * *scale);
            (scale, range)
        });
        exponent.map(|p| (p, EXPONENTS)).into_iter().chain(scale)
    }
}
