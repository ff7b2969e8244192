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
}

impl From<&fit::RecordingError> for RecordingError {
    fn from(error: &fit::RecordingError) -> Self {
        let role = if error.held_out { "held_out" } else { "fitted" };
        RecordingError {
            file: error.source.clone(),
            role: role.to_owned(),
            samples: error.samples,
            rms_counts: finite(error.rms_counts),
        }
    }
}
