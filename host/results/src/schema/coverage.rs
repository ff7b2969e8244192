//! `servoid.coverage/1`: how often standard errors hold what they promise.

use super::proof::Share;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `servoid.coverage/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Coverage {
    /// `servoid.coverage/1`.
    pub schema: String,
    /// Version of the program that fitted the recordings.
    pub version: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Recordings that were fitted.
    pub recordings: u64,
    /// Recordings that could not be fitted.
    pub failures: u64,
    /// Each drive and encoder.
    pub conditions: Vec<Condition>,
    /// Whether the user stopped the work.
    pub interrupted: bool,
}

/// The recordings of one drive and one encoder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Condition {
    /// How the motor is driven.
    pub excitation: String,
    /// Length of a recording, s.
    pub seconds: f64,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
    /// The effect that is hidden and fitted; null for the linear motor.
    #[serde(default)]
    pub effect: Option<String>,
    /// What is minimised, as in `fit`; absent for squares.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cost: Option<String>,
    /// Noise of the angle sensor before it is floored, standard deviation, counts; absent where there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_noise_counts: Option<f64>,
    /// A load torque that is another one in each sample interval, standard deviation, as a part of the stall torque; absent where
    /// there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque_noise: Option<f64>,
    /// Whether a position loop drives the motor.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub closed_loop: bool,
    /// How the errors of each parameter lie.
    pub parameters: Vec<Covered>,
}

/// How the errors of one parameter lie in its standard errors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Covered {
    /// The parameter.
    pub name: String,
    /// How often the interval of one standard error holds the truth; 68 % is right.
    pub within_1: Share,
    /// The same of 1.96 standard errors; 95 % is right.
    pub within_2: Share,
    /// Fits that state no standard error.
    pub not_stated: u64,
    /// Mean of (estimate - truth) / standard error; 0 is right.
    pub z_mean: Option<f64>,
    /// Standard deviation of the same; 1 is right.
    pub z_sd: Option<f64>,
    /// Each of these, so that the parts of several machines can be joined.
    pub z: Vec<f64>,
}
