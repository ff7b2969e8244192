//! `servoid.verify/1`: whether a device's answer stands.

use super::diagnosis::Diagnosis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a verification calls itself.
pub const SCHEMA: &str = "servoid.verify/1";

/// `servoid.verify/1`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Verification {
    /// `servoid.verify/1`.
    #[serde(default)]
    pub schema: String,
    /// Whether the host found the device's bits.
    pub same_bits: bool,
    /// Names of what has other bits.
    #[serde(default)]
    pub differ: Vec<String>,
    /// The same model on the same recording by a stronger search.
    pub stronger: Option<Stronger>,
    /// Whether the device's answer stands.
    pub stands: bool,
    /// The same in words.
    pub verdict: String,
    /// Of the long recording, `servoid.diagnosis/1`.
    pub diagnosis: Option<Box<Diagnosis>>,
}

/// The same model on the same recording, fitted by least squares in double precision.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Stronger {
    /// What it leaves, counts RMS.
    pub rms_counts: Option<f64>,
    /// What the device's fit leaves, counts RMS.
    pub device_rms_counts: Option<f64>,
    /// Its gain, rad/(s·V).
    pub gain_rad_s_v: Option<f64>,
    /// Its time constant, s.
    pub a1_s: Option<f64>,
    /// Error of the device's gain, as a part of this one.
    pub gain_off: Option<f64>,
    /// Error of the device's time constant, as a part of this one.
    pub a1_off: Option<f64>,
    /// The bridge's dead time, where the device fits it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dead_time: Option<DeadTime>,
}

/// Dead time of a bridge, by what it takes of the supply.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DeadTime {
    /// By the device's fit, s.
    pub device_s: Option<f64>,
    /// By least squares in double precision, s.
    pub host_s: Option<f64>,
    /// By the board's own figure, s; null if it has none.
    pub told_s: Option<f64>,
}
