//! The model that the walk ends with, held against the baseline.

use super::baseline::{Baseline, Prediction};
use super::context::Context;
use super::models::FittedModel;
use super::outcome::Floor;
use shared::effects::Kind;

/// The models of one size on the way to the chosen one.
pub struct Level {
    /// All that could stand there, the one on the way first.
    pub models: Vec<FittedModel>,
    /// The one on the way.
    pub best: FittedModel,
}

/// The model that is chosen, and what it was tried against.
pub struct Chosen<'a> {
    /// The recordings.
    pub context: Context<'a>,
    /// The linear motor.
    pub base: FittedModel,
    /// The models with one effect, with two, and so on up to the chosen one.
    pub levels: Vec<Level>,
    /// The model; `None` where the linear motor is enough.
    pub model: Option<FittedModel>,
    /// Other models that were fitted.
    pub known: Vec<FittedModel>,
    /// What the model predicts, where it was held against the baseline.
    pub predicts: Option<Prediction>,
    /// The baseline that it was held against.
    pub baseline: Option<Baseline>,
    /// Whether its effects are named together although others would do as well in the place of one.
    pub as_one: bool,
    /// Sets of effects with their scores, nats.
    pub scores: Vec<(Vec<Kind>, f64)>,
    /// What stands below its error, where more than the encoder is known of it.
    pub floor: Option<Floor>,
}
