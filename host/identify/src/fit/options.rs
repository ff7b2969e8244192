//! What to fit, and how.

use super::Bound;
use crate::identify::LEAST_SQUARES;
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::Method;
use servoid_io::input::Known;
use shared::cost::Cost;
use shared::effects::Kind;

/// What to fit, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Effects beside the linear machine.
    pub effects: Vec<Kind>,
    /// What is minimised.
    pub cost: Cost,
    /// Seed of the search.
    pub seed: u64,
    /// Largest number of model evaluations.
    pub budget: usize,
    /// Length of the windows in which the model runs on its own; the whole recording if `None`.
    pub window_s: Option<f64>,
    /// How the model is run.
    pub method: Method,
    /// Facts about the motor.
    pub known: Known,
    /// Name of the search method, see [`servoid_engine::solve::all`].
    pub algorithm: String,
    /// Ranges of unknowns that the user set.
    pub bounds: Vec<Bound>,
    /// Names of unknowns that each of several recordings has for itself.
    pub own: Vec<String>,
    /// Whether the result has its [certificate](crate::certificate).
    pub certificate: bool,
    /// Whether the result has the [profile](crate::fit::Profile) of each parameter.
    pub profile: bool,
    /// A model near the solution, if the caller knows one: where least squares starts once more if it ends elsewhere.
    pub start: Option<Candidate>,
    /// Whether the result has the errors of the models that lead to it, effect by effect.
    pub error_ladder: bool,
    /// Whether recordings are fitted that the [check](crate::check) refuses.
    pub force: bool,
}

impl Options {
    /// Name of the cost in results.
    pub fn cost_name(&self) -> &'static str {
        cost_name(self.cost)
    }
}

/// Name of a cost in results.
pub fn cost_name(cost: Cost) -> &'static str {
    match cost {
        Cost::Squared => "squared",
        Cost::Absolute {
            model_floored: false,
        } => "iae",
        Cost::Absolute {
            model_floored: true,
        } => "iae_floored",
        Cost::Interval { .. } => "interval",
    }
}

impl Default for Options {
    fn default() -> Self {
        Options {
            effects: Vec::new(),
            cost: Cost::Squared,
            seed: 1,
            budget: 20_000,
            window_s: None,
            method: Method {
                substeps: 2,
                ..Method::default()
            },
            known: Known::default(),
            algorithm: LEAST_SQUARES.to_owned(),
            bounds: Vec::new(),
            own: Vec::new(),
            certificate: false,
            profile: false,
            start: None,
            error_ladder: false,
            force: false,
        }
    }
}
