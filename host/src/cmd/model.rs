//! From flags to fit options.

use crate::cli::{CostName, Integrator, ModelArgs};
use crate::error::Error;
use servoid_engine::problem::Scale;
use servoid_engine::problem::{FitProblem, Structure};
use servoid_engine::simulation::Method;
use servoid_identify::fit::Options;
use servoid_io::input::Known;
use servoid_io::input::suggest::did_you_mean;
use shared::cost::Cost;
use shared::discretise::Discretisation;
use shared::effects::{Kind, MAX_EFFECTS};

/// Noise before quantisation that the interval likelihood assumes, counts: below the floor of the
/// quantiser, above zero, so that one glitch does not make a model impossible.
const NOISE_COUNTS: f64 = 0.1;

impl CostName {
    /// The cost itself.
    pub(super) fn cost(self) -> Cost {
        match self {
            CostName::Squared => Cost::Squared,
            CostName::Iae => Cost::Absolute {
                model_floored: false,
            },
            CostName::IaeFloored => Cost::Absolute {
                model_floored: true,
            },
            CostName::Interval => Cost::Interval {
                noise_counts: NOISE_COUNTS,
            },
        }
    }

    /// Its name in JSON.
    pub(super) fn name(self) -> &'static str {
        match self {
            CostName::Squared => "squared",
            CostName::Iae => "iae",
            CostName::IaeFloored => "iae_floored",
            CostName::Interval => "interval",
        }
    }
}

/// Options of a fit from the flags.
pub(super) fn options(
    args: &ModelArgs,
    known: Known,
    seed: u64,
    budget: u64,
) -> Result<Options, Error> {
    let mut effects = Vec::new();
    for name in &args.with {
        // The flag's parser admits known names only.
        let kind = Kind::by_name(name)
            .ok_or_else(|| Error::Usage(format!("--with {name}: unknown effect")))?;
        if effects.contains(&kind) {
            return Err(Error::Usage(format!("--with {name}: named twice")));
        }
        effects.push(kind);
    }
    if effects.len() > MAX_EFFECTS {
        return Err(Error::Usage(format!(
            "--with: at most {MAX_EFFECTS} effects fit into one model"
        )));
    }
    if let Some(window) = args.window
        && !(window.is_finite() && window > 0.0)
    {
        return Err(Error::Usage(format!(
            "--window {window}: must be a positive number of seconds"
        )));
    }
    Ok(Options {
        effects,
        cost: args.cost.cost(),
        seed,
        budget: usize::try_from(budget).unwrap_or(usize::MAX),
        window_s: args.window,
        method: Method {
            discretisation: match args.integrator {
                Integrator::Exact => Discretisation::Exact,
                Integrator::Euler => Discretisation::Euler,
            },
            substeps: args.substeps,
        },
        known,
    })
}

/// A range `LOW:HIGH` of a flag.
pub(super) fn range(flag: &str, text: &str) -> Result<(f64, f64), Error> {
    let wrong = |why: &str| Error::Usage(format!("{flag} {text}: {why}"));
    let (low, high) = text
        .split_once(':')
        .ok_or_else(|| wrong("write it like 1e-4:1.5"))?;
    let number = |part: &str| {
        part.trim()
            .parse::<f64>()
            .ok()
            .filter(|x| x.is_finite())
            .ok_or_else(|| wrong(&format!("`{part}` is not a finite number")))
    };
    let (low, high) = (number(low)?, number(high)?);
    if low >= high {
        return Err(wrong("the bounds are crossed: the lower one comes first"));
    }
    Ok((low, high))
}

/// Applies `--bounds NAME=LOW:HIGH` to the unknowns; a start outside moves to the nearest bound.
pub(super) fn apply_bounds(problem: &mut FitProblem<'_>, bounds: &[String]) -> Result<(), Error> {
    if bounds.is_empty() {
        return Ok(());
    }
    let start = problem.start.as_ref().map(|x| problem.structure.values(x));
    for bound in bounds {
        let (name, text) = bound
            .split_once('=')
            .ok_or_else(|| Error::Usage(format!("--bounds {bound}: write it like gain=10:100")))?;
        let range = range(&format!("--bounds {name} ="), text)?;
        set_range(&mut problem.structure, name, range)?;
    }
    problem.start = start.map(|values| problem.structure.coordinates(&values));
    Ok(())
}

fn set_range(structure: &mut Structure, name: &str, range: (f64, f64)) -> Result<(), Error> {
    let names: Vec<String> = structure.unknowns.iter().map(|u| u.name.clone()).collect();
    let Some(unknown) = structure
        .unknowns
        .iter_mut()
        .find(|unknown| unknown.name == name)
    else {
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        return Err(Error::Usage(format!(
            "--bounds {name}: not an unknown of this model; {}",
            did_you_mean(name, &names)
        )));
    };
    let least = unknown.range.0;
    if range.0 < 0.0 && least >= 0.0 {
        return Err(Error::Usage(format!(
            "--bounds {name}: the lower bound {} is negative, and {name} cannot be",
            range.0
        )));
    }
    if range.0 == 0.0 && unknown.scale == Scale::Log {
        return Err(Error::Usage(format!(
            "--bounds {name}: the lower bound must be above zero"
        )));
    }
    unknown.range = range;
    Ok(())
}
