//! Work that a page asks for, checked before it begins.

use super::answer::{Answer, done};
use super::opened::Role;
use super::routes::Shared;
use super::{driven, job, work};
use crate::error::Error;
use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use servoid_identify::LEAST_SQUARES;
use servoid_identify::fit::effects_by_name;
use shared::effects::Kind;

/// A piece of work.
#[derive(Deserialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub(super) enum Work {
    Fit {
        #[serde(default)]
        effects: Vec<String>,
        #[serde(default)]
        algorithm: Option<String>,
    },
    Suggest {
        model: usize,
    },
    Diagnose,
    Twins {
        model: usize,
    },
    /// Excites the motor of the device.
    Record {
        seconds: f64,
        #[serde(default)]
        role: Role,
    },
    /// Plans the experiment that decides.
    Plan {
        seconds: f64,
    },
    /// Records it.
    Play,
    /// Lets the device identify its motor.
    Commission {
        seconds: f64,
    },
    Race {
        #[serde(default)]
        effects: Vec<String>,
        algorithms: Vec<String>,
        /// Numbers as they were typed: a fraction is refused in words, not by its type.
        budget: f64,
        seeds: f64,
    },
}

/// Most evaluations and seeds of a race on the page; `servoid compare` has no such limit.
const MOST_BUDGET: f64 = 20_000.0;
const MOST_SEEDS: f64 = 100.0;
/// Longest run of a motor from the page, s.
const MOST_SECONDS: f64 = 600.0;

pub(super) async fn begin(State(bench): Shared, Json(asked): Json<Work>) -> Answer {
    match asked {
        Work::Fit { effects, algorithm } => {
            let effects = kinds(&effects)?;
            let algorithm = algorithm.unwrap_or_else(|| LEAST_SQUARES.to_owned());
            job::start(&bench, "fit", move |bench| {
                work::fit(bench, &effects, &algorithm)
            })?;
        }
        Work::Suggest { model } => {
            job::start(&bench, "suggest", move |bench| work::suggest(bench, model))?;
        }
        Work::Twins { model } => {
            job::start(&bench, "twins", move |bench| work::twins(bench, model))?;
        }
        Work::Record { seconds, role } => {
            let seconds = within_minutes(seconds)?;
            bench.device()?.disarm()?;
            job::start(&bench, "record", move |bench| {
                driven::record(bench, seconds, role)
            })?;
        }
        Work::Plan { seconds } => {
            let seconds = within_minutes(seconds)?;
            job::start(&bench, "plan", move |bench| driven::plan(bench, seconds))?;
        }
        Work::Play => {
            bench.device()?.disarm()?;
            job::start(&bench, "experiment", driven::play)?;
        }
        Work::Commission { seconds } => {
            let seconds = within_minutes(seconds)?;
            bench.device()?.disarm()?;
            job::start(&bench, "commission", move |bench| {
                driven::commission(bench, seconds)
            })?;
        }
        Work::Diagnose => job::start(&bench, "diagnose", work::diagnose)?,
        Work::Race {
            effects,
            algorithms,
            budget,
            seeds,
        } => {
            let effects = kinds(&effects)?;
            let whole = |name: &str, asked: f64, most: f64| -> Result<u64, Error> {
                if asked.fract() != 0.0 || !(1.0..=most).contains(&asked) {
                    return Err(Error::Usage(format!(
                        "{name} of the race: {asked} does not do; take a whole number from 1 to {most}"
                    )));
                }
                Ok(asked as u64)
            };
            if algorithms.is_empty() {
                let text = "a race needs at least one search method; tick some".to_owned();
                return Err(Error::Usage(text).into());
            }
            let budget = whole("evaluations", budget, MOST_BUDGET)?;
            let seeds = whole("seeds", seeds, MOST_SEEDS)?;
            job::start(&bench, "race", move |bench| {
                work::race(bench, &effects, &algorithms, budget as usize, seeds)
            })?;
        }
    }
    done()
}

/// A length of a run, s.
fn within_minutes(seconds: f64) -> Result<f64, Error> {
    if (1.0..=MOST_SECONDS).contains(&seconds) {
        return Ok(seconds);
    }
    Err(Error::Usage(format!(
        "{seconds} s does not do; a run from the page lasts 1 to {MOST_SECONDS} s (`servoid device record` has no such limit)"
    )))
}

fn kinds(names: &[String]) -> Result<Vec<Kind>, Error> {
    Ok(effects_by_name("the model", names)?)
}
