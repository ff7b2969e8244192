//! The position loop that made the volts of a recording of target angles.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Data;
use servoid_io::position_loop::{self, GainOrigin};

/// The position loop of one recording: `clamp(gain·(target − angle) − damping·speed, ±limit)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PositionLoop {
    /// The recording.
    pub recording: String,
    /// Volts per radian of error.
    pub gain_v_per_rad: Option<f64>,
    /// Whether the gain was estimated from the recording; else it was given.
    #[serde(default)]
    pub gain_estimated: bool,
    /// Standard error of an estimated gain, V/rad.
    pub gain_std: Option<f64>,
    /// Time for which the output stands at its limit, s, where the gain was estimated.
    pub limited_s: Option<f64>,
    /// Volts per rad/s of measured speed, against the motion.
    pub damping_v_s_per_rad: Option<f64>,
    /// Largest voltage, V.
    pub limit_v: Option<f64>,
    /// Error up to which there is no voltage, rad.
    pub dead_band_rad: Option<f64>,
    /// Rate of the loop, 1/s; null where it is taken as continuous.
    pub rate_hz: Option<f64>,
}

impl PositionLoop {
    /// The loop of a recording.
    pub fn new(recording: &str, control: &position_loop::PositionLoop) -> Self {
        let estimate = match control.origin {
            GainOrigin::Given => None,
            GainOrigin::Estimated(estimate) => Some(estimate),
        };
        PositionLoop {
            recording: recording.to_owned(),
            gain_v_per_rad: finite(control.gain_v_per_rad),
            gain_estimated: estimate.is_some(),
            gain_std: estimate.and_then(|e| finite(e.relative_std * control.gain_v_per_rad)),
            limited_s: estimate.and_then(|e| finite(e.limited_s)),
            damping_v_s_per_rad: finite(control.damping_v_s_per_rad),
            limit_v: finite(control.limit_v),
            dead_band_rad: finite(control.dead_band_rad),
            rate_hz: control.rate_hz.and_then(finite),
        }
    }

    /// Those of all recordings that have one.
    pub(crate) fn all(data: &Data) -> Vec<Self> {
        let loops = data.recordings.loops();
        loops
            .map(|(source, control)| PositionLoop::new(source, control))
            .collect()
    }
}
