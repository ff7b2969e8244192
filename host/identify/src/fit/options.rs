//! What to fit, and how.

use super::Bound;
use crate::error::Error;
use crate::identify::LEAST_SQUARES;
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::Method;
use servoid_io::input::Known;
use servoid_io::input::suggest::did_you_mean;
use shared::cost::Cost;
use shared::effects::{Kind, MAX_EFFECTS};

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
    /// Effects of the catalogue that a diagnosis tries.
    pub catalogue: Vec<Kind>,
    /// Laws that a diagnosis tries beside the effects of the catalogue.
    pub candidates: Vec<Kind>,
    /// Whether a diagnosis looks for a law of its own where the catalogue leaves something.
    pub discover: bool,
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

/// Noise before quantisation that the interval likelihood assumes, counts: below the floor of the
/// quantiser, above zero, so that one glitch does not make a model impossible.
const NOISE_COUNTS: f64 = 0.1;

/// Every cost.
pub const COSTS: [Cost; 4] = [
    Cost::Squared,
    Cost::Absolute {
        model_floored: false,
    },
    Cost::Absolute {
        model_floored: true,
    },
    Cost::Interval {
        noise_counts: NOISE_COUNTS,
    },
];

/// The cost of this name.
pub fn cost_by_name(name: &str) -> Option<Cost> {
    COSTS.into_iter().find(|cost| cost_name(*cost) == name)
}

/// The effects of these names, which stand behind `flag`; a name with a colon states a law.
///
/// # Errors
/// A name that is none, or stands twice; more than a model holds.
pub fn effects_by_name(flag: &str, names: &[String]) -> Result<Vec<Kind>, Error> {
    let mut effects = Vec::new();
    for name in names {
        // A law with its name, as it is stated.
        if name.contains(':') {
            let stated = servoid_formula::define(name);
            effects.push(stated.map_err(|fault| Error::Usage(format!("{flag}: {fault}")))?);
            continue;
        }
        let kind = servoid_formula::by_name(name).ok_or_else(|| {
            let known: Vec<&str> = Kind::ALL.iter().map(|kind| kind.name()).collect();
            Error::Usage(format!(
                "{flag} {name}: unknown effect; {}",
                did_you_mean(name, &known)
            ))
        })?;
        if effects.contains(&kind) {
            return Err(Error::Usage(format!("{flag} {name}: named twice")));
        }
        effects.push(kind);
    }
    if effects.len() > MAX_EFFECTS {
        return Err(Error::Usage(format!(
            "{flag}: at most {MAX_EFFECTS} effects fit into one model"
        )));
    }
    Ok(effects)
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
            catalogue: Kind::ALL.to_vec(),
            candidates: Vec::new(),
            discover: false,
            force: false,
        }
    }
}
