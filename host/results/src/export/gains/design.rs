//! The controllers: where their zero stands, and how fast they may be.
//!
//! *Cancel.* The zero of the PI stands on a pole `p` of the sampled motor, `1 − ki·T/kp = p`, so that an integrator, a gain and
//! the dead time are left: a phase margin of `90° − ωc·T_dead` (any text; for the current loop `kp/ki = L/R` as `T` vanishes).
//!
//! *Symmetrical optimum.* For an integrating motor behind small lags of sum `Tσ` the phase is greatest at the crossover
//! `ωc = 1/(a·Tσ)` if the zero stands at `1/(a²·Tσ)`, and the margin is `atan a − atan(1/a)` (Kessler, 1958; Umland,
//! Safiuddin, *Magnitude and symmetric optimum criterion*, IEEE Trans. Industry Applications 26(3), 1990; `a = 2` there,
//! 37°; here `1 + √2`, 45°, if nothing is asked for).
//!
//! The gain is then set on the exact sampled loop, so that it passes one just where it was asked to.

use super::super::digits::rounded;
use super::super::error::ExportError;
use super::loops::{Closed, Open, hz};
use clap::ValueEnum;
use std::f64::consts::{SQRT_2, TAU};

/// How the zero of a speed controller is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// On the motor's mechanical pole
    Cancel,
    /// By the symmetrical optimum
    Symmetrical,
}

/// Least phase margin that is written, degrees.
const LEAST_MARGIN: f64 = 30.0;
/// Below this it is written with a warning.
const GOOD_MARGIN: f64 = 45.0;
/// What is left if nothing is asked for and the zero cancels a pole.
const CALM_MARGIN: f64 = 60.0;
/// Part of the sampling rate that a current loop takes if nothing is asked for.
const USUAL_CURRENT: f64 = 1.0 / 20.0;

/// Where a controller's zero stands.
#[derive(Clone, Copy, Debug)]
pub enum Zero {
    /// On this pole of the sampled motor.
    Pole(f64),
    /// Symmetrical to the small lags of this sum, s.
    Lags(f64),
}

impl Zero {
    /// Integral over proportional part, 1/s, for a crossover in rad/s.
    fn rate(self, period: f64, crossover: f64) -> f64 {
        match self {
            Zero::Pole(pole) => (1.0 - pole) / period,
            // 1/(a²·Tσ) with a = 1/(ωc·Tσ).
            Zero::Lags(lags) => crossover * crossover * lags,
        }
    }
}

/// One loop, to be closed.
pub struct Task<'a> {
    /// As messages call it.
    pub name: &'static str,
    /// The flag that asks for its bandwidth.
    pub flag: &'static str,
    /// What was asked for, Hz.
    pub asked_hz: Option<f64>,
    /// Where its zero stands.
    pub zero: Zero,
    /// What it acts on.
    pub open: Open<'a>,
    /// Whether it is a current loop.
    pub inner: bool,
    /// What may help where it cannot be as fast as asked, beside asking for less.
    pub helps: &'static str,
}

impl Task<'_> {
    /// Closes it as asked or as usual; with a warning where little margin is left.
    ///
    /// # Errors
    /// A bandwidth that leaves less than 30° of phase margin, with the highest that leaves 45°.
    pub fn close(&self) -> Result<(Closed, Option<String>), ExportError> {
        let period = self.open.period;
        let rate = |crossover: f64| self.zero.rate(period, crossover);
        let refuse = |why: String| Err(ExportError::Loop(why));
        let crossover = match self.asked_hz {
            Some(asked) => asked * TAU,
            None => match self.usual(&rate) {
                Some(usual) => usual,
                None => {
                    return refuse(format!(
                        "{}: no gain leaves a phase margin of {GOOD_MARGIN} degrees at a control period of {period} s; give {}",
                        self.name, self.helps
                    ));
                }
            },
        };
        let limit = self.open.highest(LEAST_MARGIN, &rate);
        let closed = (limit.is_some_and(|limit| crossover <= limit))
            .then(|| self.open.close(rate(crossover), crossover))
            .flatten();
        let Some(closed) = closed else {
            let can = self.open.highest(GOOD_MARGIN, &rate);
            let can = can.map_or_else(
                || format!("none leaves {GOOD_MARGIN}"),
                |omega| {
                    format!(
                        "the highest that leaves {GOOD_MARGIN} is {:.3} Hz",
                        hz(omega)
                    )
                },
            );
            return refuse(format!(
                "{} {:?}: the {} would have less than {LEAST_MARGIN} degrees of phase margin at a control period of {period:?} s; \
                 {can}; ask for less or give {}",
                self.flag,
                rounded(hz(crossover)),
                self.name,
                self.helps
            ));
        };
        let margin = closed.phase_margin;
        let warning = (margin < GOOD_MARGIN - 0.01).then(|| {
            format!(
                "{}: a phase margin of {margin:.0} degrees is little; expect overshoot",
                self.name
            )
        });
        Ok((closed, warning))
    }

    /// The crossover if nothing is asked for, rad/s.
    fn usual(&self, rate: &dyn Fn(f64) -> f64) -> Option<f64> {
        match self.zero {
            Zero::Pole(_) => {
                let calm = self.open.highest(CALM_MARGIN, rate)?;
                let usual = TAU * USUAL_CURRENT / self.open.period;
                Some(if self.inner { calm.min(usual) } else { calm })
            }
            Zero::Lags(lags) => {
                let good = self.open.highest(GOOD_MARGIN, rate)?;
                Some(good.min(1.0 / ((1.0 + SQRT_2) * lags)))
            }
        }
    }
}
