//! From flags to fit options.

use super::formula;
use crate::cli::{CostName, Integrator, ModelArgs};
use crate::error::Error;
use servoid_engine::simulation::Method;
use servoid_identify::fit::{Bound, COSTS, Options, effects_by_name};
use servoid_io::input::Known;
use shared::cost::Cost;
use shared::discretise::Discretisation;
use shared::effects::MAX_EFFECTS;

impl CostName {
    /// The cost itself.
    pub(crate) fn cost(self) -> Cost {
        let [squared, iae, iae_floored, interval] = COSTS;
        match self {
            CostName::Squared => squared,
            CostName::Iae => iae,
            CostName::IaeFloored => iae_floored,
            CostName::Interval => interval,
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
    if let Some(window) = args.window
        && !(window.is_finite() && window > 0.0)
    {
        return Err(Error::Usage(format!(
            "--window {window}: must be a positive number of seconds"
        )));
    }
    let mut effects = effects_by_name("--with", &args.with)?;
    effects.extend(formula::stated(&args.formulas)?);
    if effects.len() > MAX_EFFECTS {
        return Err(Error::Usage(format!(
            "--with, --effect: at most {MAX_EFFECTS} effects fit into one model"
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
        bounds: args
            .bounds
            .iter()
            .map(|text| bound(text))
            .collect::<Result<_, _>>()?,
        ..Options::default()
    })
}

/// A range `LOW:HIGH` of a flag, wider than nothing.
pub(super) fn range(flag: &str, text: &str) -> Result<(f64, f64), Error> {
    let (low, high) = limits(flag, text)?;
    if low == high {
        return Err(Error::Usage(format!(
            "{flag} {text}: the bounds are equal: nothing is left to draw from"
        )));
    }
    Ok((low, high))
}

/// Limits `LOW:HIGH` of a flag; equal ones hold what they limit.
fn limits(flag: &str, text: &str) -> Result<(f64, f64), Error> {
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
    if low > high {
        return Err(wrong("the bounds are crossed: the lower one comes first"));
    }
    Ok((low, high))
}

/// A bound `NAME=LOW:HIGH` of `--bounds`.
fn bound(text: &str) -> Result<Bound, Error> {
    let (name, ends) = text
        .split_once('=')
        .ok_or_else(|| Error::Usage(format!("--bounds {text}: write it like gain=10:100")))?;
    Ok(Bound {
        name: name.to_owned(),
        range: limits(&format!("--bounds {name} ="), ends)?,
    })
}
