//! `servoid.plan/1`: what to record next, to separate effects that look alike.

use super::ModelParameter;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::plan;

/// `servoid.plan/1`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Plan {
    /// `servoid.plan/1`.
    pub schema: String,
    /// Whether the best excitation leaves at least `threshold_counts` in every pair; if not, no file is written.
    pub separable: bool,
    /// Least of all pairs of the best excitation: RMS error above the encoder's own, counts, that is left when the wrong
    /// model is fitted; an upper bound, since the refits are local searches from a few starts.
    pub separation_counts: Option<f64>,
    /// What counts as separable, counts RMS.
    pub threshold_counts: f64,
    /// The models to separate.
    pub hypotheses: Vec<Hypothesis>,
    /// The best excitations, best first.
    pub candidates: Vec<Candidate>,
    /// The file with the commands; null where none was written.
    pub plan: Option<String>,
    /// Number of commands.
    pub samples: usize,
    /// Their interval, s.
    pub sample_s: f64,
    /// Why the best separates; null where it does not.
    pub reason: Option<String>,
    /// Pairs that stay alike and what would separate them; a doubt where the separation is small.
    pub advice: Vec<String>,
    /// Seed of everything random.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
}

/// One of the models to separate; torques in V (the torque times `R/Kt`).
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Hypothesis {
    /// Its effects.
    pub effects: Vec<String>,
    /// Their parameters.
    pub parameters: Vec<ModelParameter>,
}

impl From<&plan::Hypothesis> for Hypothesis {
    fn from(hypothesis: &plan::Hypothesis) -> Self {
        Hypothesis {
            effects: (hypothesis.effects.iter())
                .map(|kind| kind.name().to_owned())
                .collect(),
            parameters: ModelParameter::all(&hypothesis.effects, &hypothesis.values),
        }
    }
}

/// One excitation, and what it asks for: the most of all hypotheses.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Candidate {
    /// The excitation.
    pub excitation: String,
    /// Least of all pairs, counts RMS.
    pub separation_counts: Option<f64>,
    /// All pairs; a model that contains the truth as a special case explains all of it and is left out.
    pub pairs: Vec<Pair>,
    /// Whether the bridge opens.
    pub coasts: bool,
    /// V.
    pub peak_voltage_v: f64,
    /// A; null without `--resistance`.
    pub peak_current_a: Option<f64>,
    /// Part of the stall current.
    pub peak_current_of_stall: f64,
    /// From end to end, revolutions.
    pub travel_rev: f64,
    /// rad/s.
    pub peak_speed_rad_s: f64,
}

/// What is left when one model is fitted and another is true.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Pair {
    /// The true model.
    pub truth: String,
    /// The fitted model.
    pub fitted: String,
    /// RMS error above the encoder's own, counts.
    pub counts: Option<f64>,
}
