//! The error of a model on one of several recordings.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::fit;

/// The error of a model on one of several recordings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RecordingError {
    /// The recording.
    pub file: String,
    /// `fitted` or `held_out`.
    pub role: String,
    /// Number of samples.
    pub samples: usize,
    /// RMS of model minus reading over the whole recording, open loop, counts.
    pub rms_counts: Option<f64>,
    /// The same while the recording's position loop drives the model towards its targets; absent where no loop drove the motor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replay_rms_counts: Option<f64>,
    /// The parameters that this recording has for itself (`fit --own`); absent where it has none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub own: Vec<OwnParameter>,
}

/// A parameter that one of several recordings has for itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct OwnParameter {
    /// Name, as among the parameters.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// Standard error; null where the recording does not determine it.
    pub std: Option<f64>,
    /// Unit symbol.
    pub unit: String,
}

impl From<&fit::OwnParameter> for OwnParameter {
    fn from(own: &fit::OwnParameter) -> Self {
        OwnParameter {
            name: own.name.clone(),
            value: own.value,
            std: own.std.and_then(finite),
            unit: own.unit.to_owned(),
        }
    }
}

impl From<&fit::RecordingError> for RecordingError {
    fn from(error: &fit::RecordingError) -> Self {
        let role = if error.held_out { "held_out" } else { "fitted" };
        RecordingError {
            file: error.source.clone(),
            role: role.to_owned(),
            samples: error.samples,
            rms_counts: finite(error.rms_counts),
            replay_rms_counts: error.replay_rms_counts.and_then(finite),
            own: error.own.iter().map(Into::into).collect(),
        }
    }
}
