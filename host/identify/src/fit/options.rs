//! What to fit, and how.

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
        }
    }
}
