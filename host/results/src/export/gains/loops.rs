//! A sampled loop at its frequencies: the motor's exact step, the controller, and the period that computing takes.
//!
//! With `z = exp(jωT)` the motor is `C·(zI − A)⁻¹·B` of its exact step (zero-order hold), so that the half period of the hold is
//! in it; the command acts one period after the reading that it follows from (`z⁻¹`). Together these are the 1.5 periods of
//! dead time that texts add to a continuous motor (Buso, Mattavelli, *Digital Control in Power Electronics*, 2006, ch. 3).
//! A speed that is the difference of counts over a period is late by another half of one; it is the exact mean here.

use super::super::discrete::step;
use super::super::error::ExportError;
use super::super::subject::Subject;
use nalgebra::Complex;
use shared::effects::Kind;
use shared::model::Increments;
use std::f64::consts::{PI, TAU};

/// A complex number.
pub type C = Complex<f64>;

/// The motor from command to readings.
#[derive(Clone, Copy, Debug)]
pub struct Plant {
    by: Increments,
    /// Control period, s.
    pub period: f64,
    /// What the model's delay adds, s.
    late: f64,
}

/// `exp(jωT) − 1` without loss of digits at low frequencies.
fn ahead(omega: f64, period: f64) -> C {
    let half = (0.5 * omega * period).sin();
    C::new(-2.0 * half * half, (omega * period).sin())
}

impl Plant {
    /// The subject's linear machine under a controller of this period, s.
    ///
    /// # Errors
    /// A step that cannot be computed.
    pub fn new(subject: &Subject, period: f64) -> Result<Self, ExportError> {
        let delays = subject.terms.iter().filter(|term| term.kind == Kind::Delay);
        Ok(Plant {
            by: step(subject, period)?,
            period,
            late: (delays.filter(|term| term.determined[0]))
                .map(|term| term.values[0])
                .sum(),
        })
    }

    /// Current as `c = R·i` (V) at a reading, and the mean speed (rad/s) over the period before it, both by the command that
    /// was computed at the reading, at `omega` rad/s: one period of computing is in it.
    pub fn at(&self, omega: f64) -> [C; 2] {
        let [[cc, cw], [wc, ww]] = self.by.state;
        let [cv, wv] = self.by.state_by_command;
        let ahead = ahead(omega, self.period);
        let (a, d) = (ahead - cc, ahead - ww);
        let determinant = a * d - cw * wc;
        let current = (d * cv + cw * wv) / determinant;
        let speed = (a * wv + wc * cv) / determinant;
        let [tc, tw] = self.by.angle;
        let turned = current * tc + speed * tw + self.by.angle_by_command;
        let before = C::from_polar(1.0, -omega * self.period);
        let computed = C::from_polar(1.0, -omega * (self.period + self.late));
        [current * computed, turned * before * computed / self.period]
    }

    /// The two poles of the step, the slower first; none where they are complex.
    pub fn poles(&self) -> Option<[f64; 2]> {
        // Of the increments, so that a slow pole keeps its digits: z − 1 solves x² − s·x + p = 0.
        let [[cc, cw], [wc, ww]] = self.by.state;
        let (sum, product) = (cc + ww, cc * ww - cw * wc);
        let root = (sum * sum - 4.0 * product).sqrt();
        if root.is_nan() {
            return None;
        }
        let fast = 0.5 * (sum - root);
        let slow = if fast == 0.0 { 0.0 } else { product / fast };
        Some([1.0 + slow, 1.0 + fast])
    }
}

/// A PI controller: `u[k] = kp·e[k] + x[k]`, `x[k+1] = x[k] + ki·T·e[k]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pi {
    /// Proportional.
    pub kp: f64,
    /// Integral, per second.
    pub ki: f64,
}

impl Pi {
    /// At a frequency.
    pub fn at(&self, omega: f64, period: f64) -> C {
        self.kp + self.ki * period / ahead(omega, period)
    }
}

/// A loop with its controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closed {
    /// The controller.
    pub pi: Pi,
    /// Where the open loop passes one for the last time, rad/s.
    pub crossover: f64,
    /// Phase margin there, degrees.
    pub phase_margin: f64,
    /// Where the closed loop falls to −3 dB, rad/s; none below half the sampling rate.
    pub bandwidth: Option<f64>,
}

/// What a controller acts on, with the period of computing in it.
pub struct Open<'a> {
    /// From the controller's output to what it controls.
    pub plant: &'a dyn Fn(f64) -> C,
    /// Control period, s.
    pub period: f64,
}

/// Frequencies that a loop is looked at, to a decade.
const TO_A_DECADE: f64 = 200.0;
/// Lowest of them, as a part of half the sampling rate.
const LOWEST: f64 = 1e-6;

impl Open<'_> {
    /// Half the sampling rate, rad/s.
    pub fn fastest(&self) -> f64 {
        PI / self.period
    }

    /// The controller whose integral is `rate` times its proportional part (1/s), with the gain for which the loop passes one
    /// at `crossover` rad/s.
    fn pi(&self, rate: f64, crossover: f64) -> Pi {
        let unit = Pi { kp: 1.0, ki: rate };
        let size = (unit.at(crossover, self.period) * (self.plant)(crossover)).norm();
        Pi {
            kp: 1.0 / size,
            ki: rate / size,
        }
    }

    fn open(&self, pi: Pi, omega: f64) -> C {
        pi.at(omega, self.period) * (self.plant)(omega)
    }

    /// Phase margin at a frequency at which the loop passes one, degrees between −180 and 180.
    fn margin(&self, pi: Pi, omega: f64) -> f64 {
        let degrees = 180.0 + self.open(pi, omega).arg().to_degrees();
        if degrees > 180.0 {
            degrees - 360.0
        } else {
            degrees
        }
    }

    /// The loop closed at `crossover` rad/s by a controller with this `rate`. None where it passes one again above.
    pub fn close(&self, rate: f64, crossover: f64) -> Option<Closed> {
        let pi = self.pi(rate, crossover);
        if !(pi.kp.is_finite() && pi.ki.is_finite()) {
            return None;
        }
        let step = 10f64.powf(1.0 / TO_A_DECADE);
        let mut omega = crossover * step;
        while omega < self.fastest() {
            if self.open(pi, omega).norm() > 1.0 {
                return None;
            }
            omega *= step;
        }
        Some(Closed {
            pi,
            crossover,
            phase_margin: self.margin(pi, crossover),
            bandwidth: self.bandwidth(pi, crossover, step),
        })
    }

    fn bandwidth(&self, pi: Pi, crossover: f64, step: f64) -> Option<f64> {
        let falls = |omega: f64| {
            let open = self.open(pi, omega);
            (open / (open + 1.0)).norm() < std::f64::consts::FRAC_1_SQRT_2
        };
        let mut high = crossover / 4.0;
        while !falls(high) {
            high *= step;
            if high > self.fastest() {
                return None;
            }
        }
        let mut low = high / step;
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            *(if falls(middle) { &mut high } else { &mut low }) = middle;
        }
        Some(high)
    }

    /// The highest crossover up to which all leave this phase margin, degrees, if the controller's rate follows from it,
    /// rad/s. Beyond it the phase may turn once around and seem to be back; there the loop is not stable.
    pub fn highest(&self, margin: f64, rate: &dyn Fn(f64) -> f64) -> Option<f64> {
        let enough = |omega: f64| self.margin(self.pi(rate(omega), omega), omega) >= margin;
        let step = 10f64.powf(1.0 / TO_A_DECADE);
        let mut low = LOWEST * self.fastest();
        if !enough(low) {
            return None;
        }
        while low * step < self.fastest() && enough(low * step) {
            low *= step;
        }
        let mut high = (low * step).min(self.fastest());
        for _ in 0..60 {
            let middle = (low * high).sqrt();
            *(if enough(middle) { &mut low } else { &mut high }) = middle;
        }
        Some(low)
    }
}

/// Hz of rad/s.
pub fn hz(omega: f64) -> f64 {
    omega / TAU
}
