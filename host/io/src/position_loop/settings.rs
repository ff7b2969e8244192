//! What is said of a position loop, and a loop with all its numbers.

use super::gain::GainEstimate;

/// What a user says of a position loop; `None` where nothing is said. Every number is finite, and positive or zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoopSettings {
    /// Volts per radian of error.
    pub gain_v_per_rad: Option<f64>,
    /// Volts per rad/s of measured speed, against the motion; zero if not said.
    pub damping_v_s_per_rad: Option<f64>,
    /// Largest voltage, V; the supply if not said.
    pub limit_v: Option<f64>,
    /// Error up to which the loop gives no voltage, rad; zero if not said.
    pub dead_band_rad: Option<f64>,
    /// Rate of the loop, 1/s; continuous if not said.
    pub rate_hz: Option<f64>,
}

/// A position loop:
///
/// ```text
/// u = 0                                      where |e| ≤ dead band
/// u = clamp(gain · e − damping · ω, ±limit)  elsewhere, e = target − angle
/// ```
///
/// Angle and speed are the measured ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PositionLoop {
    /// Volts per radian of error.
    pub gain_v_per_rad: f64,
    /// Volts per rad/s of measured speed, against the motion.
    pub damping_v_s_per_rad: f64,
    /// Largest voltage, V.
    pub limit_v: f64,
    /// Error up to which the loop gives no voltage, rad.
    pub dead_band_rad: f64,
    /// Rate of the loop, 1/s; `None` for one that is much faster than the recording.
    pub rate_hz: Option<f64>,
    /// Where the gain is from.
    pub origin: GainOrigin,
}

/// Where the gain of a position loop is from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GainOrigin {
    /// The user gave it.
    Given,
    /// It was estimated from the recording.
    Estimated(GainEstimate),
}

impl LoopSettings {
    /// The loop with this gain and limit.
    pub fn with(&self, gain_v_per_rad: f64, limit_v: f64, origin: GainOrigin) -> PositionLoop {
        PositionLoop {
            gain_v_per_rad,
            damping_v_s_per_rad: self.damping_v_s_per_rad.unwrap_or(0.0),
            limit_v,
            dead_band_rad: self.dead_band_rad.unwrap_or(0.0),
            rate_hz: self.rate_hz,
            origin,
        }
    }

    /// What `other` says, and where it says nothing what this does.
    #[must_use]
    pub fn under(&self, other: &LoopSettings) -> LoopSettings {
        LoopSettings {
            gain_v_per_rad: other.gain_v_per_rad.or(self.gain_v_per_rad),
            damping_v_s_per_rad: other.damping_v_s_per_rad.or(self.damping_v_s_per_rad),
            limit_v: other.limit_v.or(self.limit_v),
            dead_band_rad: other.dead_band_rad.or(self.dead_band_rad),
            rate_hz: other.rate_hz.or(self.rate_hz),
        }
    }
}

impl PositionLoop {
    /// The volts at an error, rad, and a speed, rad/s.
    pub fn volts(&self, error: f64, speed: f64) -> f64 {
        if self.dead_band_rad > 0.0 && error.abs() <= self.dead_band_rad {
            return 0.0;
        }
        let wanted = self.gain_v_per_rad * error - self.damping_v_s_per_rad * speed;
        wanted.max(-self.limit_v).min(self.limit_v)
    }
}
