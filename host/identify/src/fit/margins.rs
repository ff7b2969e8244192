//! Stability margins of the position loop `θ/V` closed with unity feedback, as in the paper.
//!
//! With `L(s) = 1/(s·(a3·s² + a2·s + a1))` (rad/V) the phase reaches −180° at `ω² = a1/a3`, where
//! `|L| = a3/(a1·a2)`; the phase margin is taken where `|L| = 1`.

use shared::motor::Machine;

/// Gain and phase margin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Gain margin, dB; infinite for a loop of second order.
    pub gain_db: f64,
    /// Phase margin, degrees.
    pub phase_deg: f64,
}

/// Coefficients of the loop's denominator `s·(a3·s² + a2·s + a1)`, V·s³/rad, V·s²/rad, V·s/rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loop {
    /// Of s³.
    pub a3: f64,
    /// Of s².
    pub a2: f64,
    /// Of s.
    pub a1: f64,
}

impl From<&Machine<f64>> for Loop {
    fn from(machine: &Machine<f64>) -> Self {
        Loop {
            a3: machine.electrical * machine.inertia,
            a2: machine.inertia + machine.electrical * machine.damping,
            a1: machine.kb + machine.damping,
        }
    }
}

impl Loop {
    /// Magnitude (rad/V) and phase (degrees, from −90 to −270) at `omega` rad/s.
    pub fn response(&self, omega: f64) -> (f64, f64) {
        // The denominator at s = jω: −a2·ω² + j·(a1·ω − a3·ω³).
        let real = -self.a2 * omega * omega;
        let imaginary = self.a1 * omega - self.a3 * omega.powi(3);
        let angle = libm::atan2(imaginary, real).to_degrees();
        let lag = if angle < 0.0 { angle + 360.0 } else { angle };
        (1.0 / libm::hypot(real, imaginary), -lag)
    }

    /// The margins. `None` where a coefficient is not positive, so that there is no loop to judge.
    pub fn margins(&self) -> Option<Margins> {
        if !(self.a1 > 0.0 && self.a2 > 0.0 && self.a3 >= 0.0) {
            return None;
        }
        let gain_db = if self.a3 > 0.0 {
            20.0 * libm::log10(self.a1 * self.a2 / self.a3)
        } else {
            f64::INFINITY
        };
        let (_, phase) = self.response(self.crossover()?);
        Some(Margins {
            gain_db,
            phase_deg: 180.0 + phase,
        })
    }

    /// Where the magnitude passes one for the last time: bisection in the logarithm, downwards from a
    /// frequency above which the magnitude is below one for certain.
    fn crossover(&self) -> Option<f64> {
        let above = |omega: f64| self.response(omega).0 > 1.0;
        let mut high = 1.0;
        while above(high) && high < 1e150 {
            high *= 2.0;
        }
        // Fine enough to meet a resonance peak from its upper side.
        let mut low = high;
        let top = (self.a1 / self.a3.max(f64::MIN_POSITIVE)).sqrt() * 4.0;
        if top.is_finite() {
            high = high.max(top);
            low = high;
        }
        while !above(low) {
            high = low;
            low *= 0.98;
            if low < 1e-150 {
                return None;
            }
        }
        for _ in 0..200 {
            let middle = (low * high).sqrt();
            if above(middle) {
                low = middle
            } else {
                high = middle
            }
        }
        Some((low * high).sqrt())
    }
}
