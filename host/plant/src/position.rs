//! A drive that closes a position loop with a microcontroller of its own: at its own instants it reads the encoder and sets
//! the bridge, which holds until the next.

use super::{BenchError, DriveSample};
use std::f64::consts::TAU;

/// Times that differ by less are one, s: they are products and quotients of round numbers.
const TOGETHER_S: f64 = 1e-9;

/// A position loop, as the drive runs it.
///
/// ```text
/// u = clamp(gain (target − angle) − damping Δangle/T, ±limit)
/// ```
///
/// The angle is the counter's, T the loop's period. Within the dead band of the error the bridge gives no voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionControl {
    /// Volts per radian of error.
    pub gain_v_per_rad: f64,
    /// Volts per rad/s of measured speed, against the motion.
    pub damping_v_s_per_rad: f64,
    /// Largest voltage, V.
    pub limit_v: f64,
    /// Error up to which there is no voltage, rad.
    pub dead_band_rad: f64,
    /// Instants per second.
    pub rate_hz: f64,
}

impl PositionControl {
    /// A loop of this gain and largest voltage: 5 kHz, no damping, no dead band.
    pub fn proportional(gain_v_per_rad: f64, limit_v: f64) -> Self {
        PositionControl {
            gain_v_per_rad,
            damping_v_s_per_rad: 0.0,
            limit_v,
            dead_band_rad: 0.0,
            rate_hz: 5e3,
        }
    }

    /// Refuses numbers that no drive has.
    pub(super) fn check(&self) -> Result<(), BenchError> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let at_least_zero = |value: f64| value >= 0.0 && value.is_finite();
        let (gain, damping, limit) = (self.gain_v_per_rad, self.damping_v_s_per_rad, self.limit_v);
        let (dead, rate) = (self.dead_band_rad, self.rate_hz);
        let settings = [
            ("gain_v_per_rad", gain, positive(gain), "above zero"),
            (
                "damping_v_s_per_rad",
                damping,
                at_least_zero(damping),
                "zero or above",
            ),
            ("limit_v", limit, positive(limit), "above zero"),
            ("dead_band_rad", dead, at_least_zero(dead), "zero or above"),
            (
                "rate_hz",
                rate,
                (10.0..=1e6).contains(&rate),
                "10 to 1 000 000",
            ),
        ];
        for (setting, value, holds, need) in settings {
            BenchError::require(holds, setting, value, need)?;
        }
        Ok(())
    }
}

/// The loop in action.
pub(super) struct Controller {
    control: PositionControl,
    counts_per_rev: f64,
    /// Number of the next instant.
    instant: u64,
    /// Counter at the last one.
    last: Option<i64>,
}

impl Controller {
    pub(super) fn new(control: PositionControl, counts_per_rev: u32) -> Self {
        Controller {
            control,
            counts_per_rev: f64::from(counts_per_rev),
            instant: 0,
            last: None,
        }
    }

    /// Time of the next instant if it comes before `end_s`. One that falls together with the end, but for rounding, comes after
    /// it: there the next target is in force.
    pub(super) fn next_before(&self, end_s: f64) -> Option<f64> {
        let next = self.instant as f64 / self.control.rate_hz;
        (next < end_s - TOGETHER_S).then_some(next)
    }

    /// What the bridge is told at this instant, for a target in rad.
    pub(super) fn act(&mut self, target: DriveSample, counts: i64) -> DriveSample {
        let rad = TAU / self.counts_per_rev;
        let moved = counts - self.last.unwrap_or(counts);
        self.last = Some(counts);
        self.instant += 1;
        let error = target.volts - counts as f64 * rad;
        let PositionControl {
            gain_v_per_rad,
            damping_v_s_per_rad,
            limit_v,
            dead_band_rad,
            rate_hz,
        } = self.control;
        let wanted = gain_v_per_rad * error - damping_v_s_per_rad * moved as f64 * rad * rate_hz;
        let volts = if error.abs() <= dead_band_rad && dead_band_rad > 0.0 {
            0.0
        } else {
            wanted.clamp(-limit_v, limit_v)
        };
        DriveSample { volts, ..target }
    }
}
