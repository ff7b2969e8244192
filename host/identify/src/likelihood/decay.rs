//! What an interval does to a speed that decays with `b/a`, and the noise that it adds.
//!
//! All by functions that keep their digits where the damping vanishes: `φ₁ = (1 − e^−x)/x`, `φ₂ = (x − 1 + e^−x)/x²`.

/// Below this, series.
const SMALL: f64 = 1e-2;

/// `φ₁` and `φ₂` at `x`.
#[inline(always)]
pub(super) fn phi(x: f64) -> (f64, f64) {
    if x.abs() < SMALL {
        let first = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0)));
        let second = 0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x / 720.0)));
        (first, second)
    } else {
        let first = -libm::expm1(-x) / x;
        (first, (1.0 - first) / x)
    }
}

/// What an interval of some length does at constant direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decay {
    /// Speed by speed: `e^−x`.
    pub(super) speed: f64,
    /// Angle by speed, s; times `1/a` it is also the speed by volts.
    pub(super) angle: f64,
    /// Angle by volts, times `a`, s².
    pub(super) angle_by_force: f64,
}

impl Decay {
    /// Of `seconds` at the rate `b/a`, 1/s.
    #[inline(always)]
    pub(super) fn new(seconds: f64, rate: f64) -> Self {
        let x = seconds * rate;
        let (first, second) = phi(x);
        Decay {
            speed: 1.0 - x * first,
            angle: seconds * first,
            angle_by_force: seconds * seconds * second,
        }
    }
}

/// Covariance of angle and speed that white acceleration of unit intensity adds in an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    pub(super) angle: f64,
    pub(super) cross: f64,
    pub(super) speed: f64,
}

impl Noise {
    /// In `seconds` at the rate `b/a`, 1/s.
    pub(super) fn new(seconds: f64, rate: f64) -> Self {
        let x = seconds * rate;
        let (first, _) = phi(x);
        let (double, _) = phi(2.0 * x);
        // ∫ ((1 − e^−rs)/r)² ds = h³·(1 − 2·φ₁(x) + φ₁(2x))/x², h³/3 for small x.
        let angle = if x < 3e-2 {
            1.0 / 3.0 - x * (0.25 - x * (7.0 / 60.0 - x / 24.0))
        } else {
            (1.0 - 2.0 * first + double) / (x * x)
        };
        Noise {
            angle: angle * seconds.powi(3),
            cross: 0.5 * (seconds * first).powi(2),
            speed: seconds * double,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_noise_of_two_halves_is_that_of_the_whole() {
        for rate in [0.0, 1e-3, 2.0, 29.0, 31.0, 100.0, 3e3] {
            let (half, whole) = (Noise::new(5e-4, rate), Noise::new(1e-3, rate));
            let step = Decay::new(5e-4, rate);
            let (e, g) = (step.speed, step.angle);
            let speed = e * e * half.speed + half.speed;
            let cross = e * (half.cross + g * half.speed) + half.cross;
            let angle = half.angle + 2.0 * g * half.cross + g * g * half.speed + half.angle;
            for (is, should) in [
                (speed, whole.speed),
                (cross, whole.cross),
                (angle, whole.angle),
            ] {
                assert!(
                    (is / should - 1.0).abs() < 1e-6,
                    "{rate}: {is} for {should}"
                );
            }
        }
    }

    #[test]
    fn series_and_closed_form_meet() {
        for x in [SMALL * 0.999_999, SMALL] {
            let closed = (1.0 - libm::exp(-x)) / x;
            let (first, second) = phi(x);
            assert!((first - closed).abs() < 1e-12);
            assert!((second - (1.0 - closed) / x).abs() < 1e-9);
        }
    }
}
