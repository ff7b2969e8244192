//! What repeats of a command say of a model.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::repeats;

/// A model's error over repeats of a command, in windows that each begin at the measured state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LackOfFit {
    /// The model's error over what the motor does not repeat: one where the model lacks nothing.
    pub ratio: Option<f64>,
    /// Probability of so much in common between repeats by chance.
    pub p_value: Option<f64>,
    /// Runs that repeat another or are repeated.
    pub repeats: usize,
    /// Length of the windows, s.
    pub window_s: Option<f64>,
    /// RMS error of the model, counts.
    pub model_counts: Option<f64>,
    /// RMS of what differs between repeats, counts.
    pub noise_counts: Option<f64>,
    /// RMS of what all repeats have in common, counts.
    pub systematic_counts: Option<f64>,
    /// RMS deviation of whole runs from their mean, counts.
    pub over_run_counts: Option<f64>,
}

impl From<repeats::LackOfFit> for LackOfFit {
    fn from(found: repeats::LackOfFit) -> Self {
        LackOfFit {
            ratio: finite(found.ratio()),
            p_value: finite(found.p_value),
            repeats: found.runs,
            window_s: finite(found.window_s),
            model_counts: finite(found.model_counts),
            noise_counts: finite(found.noise_counts),
            systematic_counts: finite(found.systematic_counts),
            over_run_counts: finite(found.over_run_counts),
        }
    }
}
