//! Names the physics that a model lacks: fits the linear motor, and while the error is above the
//! encoder's floor, refits with every effect of the catalogue in turn and judges them on the fitted
//! and on a held-out recording together.
//!
//! An effect is named only where the held-out error agrees; otherwise the verdict says that
//! something is missing and that nothing in the catalogue explains it.
//!
//! [`search_catalogue`] is a pipeline. Each stage takes what the one before hands over:
//!
//! | stage | takes | hands over | where |
//! |---|---|---|---|
//! | prepare | both recordings, options, budget | `Context` | `context` |
//! | fit the linear motor | `Context` | `Linear`: the span of the runs, the motor, where the search starts | `linear` |
//! | thin | `Linear` | `Linear` along fewer readings, where models run in windows and a log holds many more than a motor of its time constant asks for | `thinned` |
//! | walk | `Linear` | `Chosen`: the set of effects with the best score, or the simplest that comes down to the encoder's error | `walk`, `score` |
//! | hold to the baseline | `Chosen` | `Chosen`: predicts no worse than the linear motor with Coulomb friction, offset and delay | `baseline` |
//! | name them | `Chosen` | `Named`: the steps that may be named | `naming` |
//! | weigh them | `Named` | [`ProbableSet`]s: sets of effects with their probabilities | `hypotheses` |
//! | conclude | `Named` | [`Diagnosis`]: verdict and advice | `conclude`, `outcome` |
//!
//! Below the stages, each knows only those above it in this list:
//!
//! | module | holds |
//! |---|---|
//! | `recordings` | what is wrong with a recording, and which part is held out |
//! | `models` | fitted and screened models and their errors, as plain data |
//! | `context` | the recordings, how models run along them, and the budget |
//! | `candidate` | one model: searched for, scored, held to the readings by an observer, polished |
//! | `spectrum` | the orders of the angle at which a torque repeats |
//! | `screening` | one effect more, fitted roughly along the measured motion |
//! | `negligible` | which effects are too small to be named |
//! | `ordered` | a model with its effects in another order |
//! | `gain` | what an effect more takes away of the error |
//! | `rivals` | what may stand in the place of an effect |
//! | `chosen` | the model that is chosen, as stages hand it on |
//! | `settings` | the numbers that decide, of stages without a file for theirs |
//! | `lost_counts` | jumps of the reading by whole counts |
//!
//! Beside the pipeline stand [`Criterion`] (over which span models are judged), [`suggest()`] (one step of it for a given model), [`built_up()`] (a start for a fit),
//! [`settle()`] (the last model with intervals), and `explain`: what is said of a diagnosis ([`evidence`], [`advice`], [`pair`]).

mod baseline;
mod built_up;
mod candidate;
mod chosen;
mod conclude;
mod context;
mod criterion;
mod explain;
mod gain;
mod hypotheses;
mod linear;
mod lost_counts;
mod models;
mod naming;
mod negligible;
mod ordered;
mod outcome;
mod recordings;
mod rivals;
mod score;
mod screening;
mod settings;
mod settle;
mod spectrum;
mod suggest;
mod thinned;
mod walk;

pub use baseline::{Baseline, Prediction};
pub use built_up::{built_up, is_lost};
pub use context::{Budget, Span, USUAL_STEPS, moves_both_ways, together_move_both_ways};
pub use criterion::Criterion;
pub use explain::{advice, evidence, pair};
pub use hypotheses::ProbableSet;
pub use models::{Errors, FittedModel, Loss, Losses, NOISE_COUNTS, ObserverErrors, same};
pub use outcome::{Diagnosis, Floor, FloorKind, Repeated, Step, Verdict};
pub use recordings::{HeldOut, Remark, holdout, usable};
pub use score::Foretold;
pub use settle::settle;
pub use spectrum::{Line, Spectrum, lines as order_lines};
pub use suggest::{Suggestion, Suggestions, suggest};

use crate::error::Error;
use crate::fit::Options;
use baseline::hold_to_baseline;
use chosen::Chosen;
use conclude::conclude;
use context::Context;
use linear::{Linear, fit_linear_motor};
use naming::name_effects;
use servoid_engine::problem::Data;
use thinned::{Thinned, on_all_readings};
use walk::{Answer, told, walk};

/// The walk, along as many readings as it needs.
fn found<'a>(linear: Linear<'a>, done: &(dyn Fn() + Sync)) -> Chosen<'a> {
    let thinned = Thinned::of(&linear);
    match thinned.as_ref().and_then(|thinned| thinned.linear(&linear)) {
        Some(fewer) => on_all_readings(linear, walked(fewer, done)),
        None => walked(linear, done),
    }
}

/// The walk, held to the baseline, and what the score tells of the model that it ends with.
fn walked<'a>(linear: Linear<'a>, done: &(dyn Fn() + Sync)) -> Chosen<'a> {
    let Linear {
        context,
        base,
        anchor,
    } = linear;
    let Answer {
        chosen,
        levels,
        known,
        scores,
        explained,
    } = walk(&context, &anchor, done);
    let linear = base.clone();
    let mut held = hold_to_baseline(Chosen {
        context,
        base,
        levels,
        model: chosen,
        known,
        predicts: None,
        baseline: None,
        as_one: !explained,
        scores,
        floor: None,
    });
    let last = held.model.as_mut().unwrap_or(&mut held.base);
    if let Some((standard_errors, floor)) = told(&held.context, &linear, last) {
        last.standard_errors = standard_errors;
        held.floor = Some(floor);
    }
    held
}

/// Diagnoses `data`, judging by `held_out`, which is never fitted. `done` is called after each piece of work.
///
/// # Errors
/// [`Error::Failed`] where not even the linear motor can be fitted.
pub fn search_catalogue(
    data: &Data,
    held_out: &Data,
    options: &Options,
    budget: &Budget<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<Diagnosis, Error> {
    let prepared = Context::new(data, held_out, options, budget);
    let linear = fit_linear_motor(prepared, options)?;
    Ok(conclude(name_effects(found(linear, done))))
}
