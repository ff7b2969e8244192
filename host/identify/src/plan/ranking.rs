//! The candidates with the largest separation.
//!
//! First each hypothesis is fitted to each other one on a common recording, as it would have been to
//! the recording that both explain: a refit from there converges fast. A refit that is cut short
//! leaves too much, never too little: its separation is an upper bound. So all candidates are screened
//! with a single step, and then only those whose bound is among the best are refitted with more steps,
//! until the best three are fully refitted. No candidate that was dropped can be better.

use super::candidates::{Frame, all};
use super::excitation::Excitation;
use super::hypothesis::{Hypothesis, Setup};
use super::limits::{Limits, Usage};
use super::separation::{RefitBudget, Separation, Trial};
use crate::error::Error;
use rayon::prelude::*;
use shared::error::ModelError;
use shared::excite::{COMMISSIONING, Command};
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of candidates ranked.
const RANKED: usize = 3;
/// Budgets in turn; the first screens.
const BUDGETS: [RefitBudget; 4] = [
    RefitBudget {
        steps: 1,
        regression: 0,
    },
    RefitBudget {
        steps: 4,
        regression: 0,
    },
    RefitBudget {
        steps: 12,
        regression: 0,
    },
    RefitBudget {
        steps: 15,
        regression: 8,
    },
];
/// Steps of the first fit of one hypothesis to another.
const LEARNING: RefitBudget = RefitBudget {
    steps: 25,
    regression: 10,
};
/// Longest recording of the first fits, s.
const IMITATION_SECONDS: f64 = 8.0;
/// Input of the ranking.
pub struct PlanTask<'a> {
    /// The rival hypotheses; at least two.
    pub hypotheses: &'a [Hypothesis],
    /// Drive, encoder and motor.
    pub setup: Setup,
    /// Limits of the excitation.
    pub limits: Limits,
    /// Length of the excitation, s.
    pub seconds: f64,
    /// Seed of telegraphs.
    pub seed: u64,
    /// Ends the work early.
    pub stop: &'a AtomicBool,
    /// Called after each candidate that was screened or refitted.
    pub done: &'a (dyn Fn() + Sync),
}

/// A candidate with its separations.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The excitation, within the limits.
    pub excitation: Excitation,
    /// Its peak values.
    pub usage: Usage,
    /// Of each ordered pair that can be told apart.
    pub separations: Vec<Separation>,
    /// Number of budgets spent.
    rounds: usize,
}

impl Ranked {
    /// The least separation of all pairs, counts.
    pub fn least(&self) -> f64 {
        let counts = self.separations.iter().map(|pair| pair.counts);
        counts.fold(f64::INFINITY, f64::min)
    }
}

/// Number of candidates to screen.
pub fn candidate_count(task: &PlanTask<'_>) -> usize {
    all(&frame(task)).len()
}

/// The best candidates within the limits, best first.
///
/// # Errors
/// [`Error::Failed`] where no candidate keeps to the limits, or the user stopped before one was
/// ranked; a hypothesis that is no possible model.
pub fn rank(task: &PlanTask<'_>) -> Result<Vec<Ranked>, Error> {
    let candidates = all(&frame(task));
    let pairs = imitations(task)?;
    let admitted: Vec<Option<Ranked>> = candidates
        .par_iter()
        .map(|candidate| admitted(task, candidate, &pairs))
        .collect::<Result<_, ModelError>>()?;
    let mut ranked: Vec<Ranked> = admitted.into_iter().flatten().collect();
    if ranked.is_empty() {
        return Err(Error::Failed(beyond_limits(task)));
    }
    while !stopped(task) {
        sort(&mut ranked);
        let next = next(&ranked);
        if next.is_empty() {
            break;
        }
        let refitted: Vec<(usize, Ranked)> = next
            .into_par_iter()
            .map(|k| refitted(task, &ranked[k]).map(|refitted| (k, refitted)))
            .collect::<Result<_, ModelError>>()?;
        for (k, better) in refitted {
            ranked[k] = better;
        }
    }
    sort(&mut ranked);
    ranked.retain(|candidate| candidate.rounds == BUDGETS.len());
    ranked.truncate(RANKED);
    if ranked.is_empty() {
        return Err(Error::Failed(
            "stopped by the user before any excitation was ranked; nothing was written".to_owned(),
        ));
    }
    Ok(ranked)
}

fn frame(task: &PlanTask<'_>) -> Frame {
    let slowest = |h: &Hypothesis| h.machine.response().a1;
    let response_s = task.hypotheses.iter().map(slowest).fold(0.0, f64::max);
    Frame {
        seconds: task.seconds,
        sample_s: task.setup.sample_s,
        response_s,
        largest: task.limits.largest_command(task.setup.supply_v),
    }
}

/// The pairs, each with the values by which one imitates the other while the bridge is closed.
fn imitations(task: &PlanTask<'_>) -> Result<Vec<Separation>, ModelError> {
    let imitation = Frame {
        seconds: task.seconds.min(IMITATION_SECONDS),
        ..frame(task)
    };
    let drive = imitation
        .stretched(&COMMISSIONING, 1.0)
        .drive(task.setup.sample_s, task.seed);
    refitted_pairs(task, &drive, &Separation::pairs(task.hypotheses), LEARNING)
}

fn stopped(task: &PlanTask<'_>) -> bool {
    task.stop.load(Ordering::Relaxed)
}

/// Screens a candidate, if it can be brought within the limits.
fn admitted(
    task: &PlanTask<'_>,
    candidate: &Excitation,
    pairs: &[Separation],
) -> Result<Option<Ranked>, ModelError> {
    if stopped(task) {
        return Ok(None);
    }
    let admitted = (task.limits).admit(candidate, task.hypotheses, &task.setup, task.seed)?;
    let Some((excitation, usage)) = admitted else {
        (task.done)();
        return Ok(None);
    };
    let unknown = Ranked {
        excitation,
        usage,
        separations: pairs.to_vec(),
        rounds: 0,
    };
    refitted(task, &unknown).map(Some)
}

/// The candidate refitted with its next budget; as it was where the user stopped that.
fn refitted(task: &PlanTask<'_>, candidate: &Ranked) -> Result<Ranked, ModelError> {
    let mut candidate = candidate.clone();
    let budget = BUDGETS[candidate.rounds.min(BUDGETS.len() - 1)];
    let drive = (candidate.excitation).drive(task.setup.sample_s, task.seed);
    let separations = refitted_pairs(task, &drive, &candidate.separations, budget)?;
    if stopped(task) {
        return Ok(candidate);
    }
    candidate.separations = separations;
    candidate.rounds += 1;
    (task.done)();
    Ok(candidate)
}

fn refitted_pairs(
    task: &PlanTask<'_>,
    drive: &[Command<f64>],
    pairs: &[Separation],
    budget: RefitBudget,
) -> Result<Vec<Separation>, ModelError> {
    let trial = Trial {
        hypotheses: task.hypotheses,
        setup: &task.setup,
        drive,
        stop: task.stop,
    };
    let refit = |pair: &Separation| trial.refit(pair, budget);
    pairs.par_iter().map(refit).collect()
}

/// The candidates among the best that have a budget left.
fn next(sorted: &[Ranked]) -> Vec<usize> {
    (0..sorted.len().min(RANKED))
        .filter(|&k| sorted[k].rounds < BUDGETS.len())
        .collect()
}

/// Largest separation first; candidates that separate alike stay in their order.
fn sort(ranked: &mut [Ranked]) {
    ranked.sort_by(|a, b| b.least().total_cmp(&a.least()));
}

fn beyond_limits(task: &PlanTask<'_>) -> String {
    if stopped(task) {
        return "stopped by the user before any excitation was tried; nothing was written"
            .to_owned();
    }
    let names: Vec<String> = task.hypotheses.iter().map(Hypothesis::name).collect();
    format!(
        "no excitation keeps to the limits under each of {}, at any amplitude: the shaft drifts by itself, or the \
         limits leave no room; raise --travel or --max-current, or shorten --seconds",
        names.join(", ")
    )
}
