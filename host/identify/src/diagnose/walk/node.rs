//! A set of effects with the best fit that is known of it.

use crate::diagnose::models::{FittedModel, distinct};
use servoid_engine::problem::{Candidate, Structure};
use shared::effects::Kind;

/// A set of effects with its best fit.
#[derive(Clone, Debug)]
pub struct Node {
    /// The effects, each once.
    pub effects: Vec<Kind>,
    /// The unknowns.
    pub structure: Structure,
    /// Where they stand in the unit cube.
    pub x: Vec<f64>,
    /// RMS error that was foreseen before it was fitted, counts; infinite where none was.
    pub foreseen: f64,
    /// The score, nats.
    pub score: f64,
    /// Whether its fit has converged under the noise by which it is scored.
    pub converged: bool,
}

impl Node {
    /// One that is not scored yet.
    pub fn new(structure: Structure, x: Vec<f64>) -> Self {
        Node {
            effects: distinct(&structure.effects),
            structure,
            x,
            foreseen: f64::INFINITY,
            score: f64::NEG_INFINITY,
            converged: false,
        }
    }

    /// Where a model stands; not scored yet.
    pub fn at(model: &FittedModel) -> Self {
        Node {
            foreseen: model.predicted_rms_counts,
            ..Node::new(model.structure.clone(), model.x.clone())
        }
    }

    /// The model.
    pub fn candidate(&self) -> Candidate {
        self.structure.candidate_at(&self.x)
    }

    /// Whether an effect of it costs much to simulate.
    pub fn is_costly(&self) -> bool {
        self.effects.iter().any(|kind| kind.facts().costly)
    }

    /// Numbers that were fitted.
    pub fn freedom(&self) -> usize {
        self.structure.dim() - self.structure.held()
    }
}
