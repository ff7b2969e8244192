//! `servoid.diagnosis/1` of a curve of steady speeds: the keys that a curve can fill, and its own.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::steady::SteadyFit;

/// The diagnosis of a curve of steady speeds.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Steady {
    /// `servoid.diagnosis/1`.
    #[serde(default)]
    pub schema: String,
    /// Always null: a curve has no encoder.
    pub quantization_floor_counts: Option<f64>,
    /// Always empty: nothing is simulated.
    #[serde(default)]
    pub base: NotSimulated,
    /// `complete`, `unexplained` or `inconclusive`.
    pub verdict: String,
    /// The verdict in words.
    pub summary: String,
    /// Always empty.
    #[serde(default)]
    pub steps: [(); 0],
    /// Always empty: nothing is simulated.
    #[serde(default, rename = "final")]
    pub last: NotSimulated,
    /// What to do next.
    #[serde(default)]
    pub advice: Vec<String>,
    /// The curve and its lines.
    pub steady: Curve,
    /// Where it came from.
    pub recording: String,
    /// Seed of the run, though nothing here is random.
    #[serde(default)]
    pub seed: u64,
    /// Always false.
    #[serde(default)]
    pub interrupted: bool,
    /// Version of the program.
    #[serde(default)]
    pub version: String,
}

/// The place of a model's errors, of which a curve has none.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
pub struct NotSimulated {
    /// Always empty.
    #[serde(default)]
    pub effects: [(); 0],
    /// Always null.
    pub rms_counts: Option<f64>,
    /// Always null.
    pub validate_rms_counts: Option<f64>,
    /// Always empty.
    #[serde(default)]
    pub parameters: [(); 0],
}

/// A curve of steady speeds and the lines through it.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Curve {
    /// How many points it has.
    #[serde(default)]
    pub points: usize,
    /// Voltage, V, and speed, rad/s.
    pub curve: Vec<(f64, f64)>,
    /// The line through the origin.
    pub linear: Line,
    /// The line with a drop.
    pub with_drop: Line,
    /// Chance of so large a drop where there is none.
    pub p_value: Option<f64>,
    /// Effects that make such a drop, none before the other.
    #[serde(default)]
    pub indistinguishable: Vec<String>,
}

/// A line through steady speeds.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Line {
    /// V·s/rad.
    pub slope_v_s_rad: f64,
    /// V.
    pub drop_v: f64,
    /// RMS error as a part of the voltage's RMS.
    pub relative: f64,
}

impl From<&SteadyFit> for Line {
    fn from(fit: &SteadyFit) -> Self {
        Line {
            slope_v_s_rad: fit.slope,
            drop_v: fit.drop_v,
            relative: fit.relative,
        }
    }
}
