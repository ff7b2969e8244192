//! The candidates with the largest separation.
//!
//! First each hypothesis learns to imitate each other one on a common recording, as it would have in
//! the recording that both explain: from there a refit has not far to go. A refit that is cut short
//! leaves too much, never too little: its separation is an upper bound. So all candidates are screened
//! with a single step, and then only those whose bound is among the best are refitted with more effort,
//! until the best three stand with all of it. Nothing that was passed over can be better than they are.

use super::candidates::{Frame, all};
use super::excitation::Excitation;
use super::hypothesis::{Hypothesis, Setup};
use super::limits::{Limits, Usage};
use super::separation::{Effort, Separation, Trial};
use crate::error::Error;
use rayon::prelude::*;
use shared::error::ModelError;
use shared::excite::{COMMISSIONING, Command};
use std::sync::atomic::{AtomicBool, Ordering};

/// How many are ranked.
const PLACES: usize = 3;
/// Efforts in turn; the first screens.
const EFFORTS: [Effort; 4] = [
    Effort {
        steps: 1,
        regression: 0,
    },
    Effort {
        steps: 4,
        regression: 0,
    },
    Effort {
        steps: 12,
        regression: 0,
    },
    Effort {
        steps: 15,
        regression: 8,
    },
];
/// Effort of learning to imitate.
const LEARNING: Effort = Effort {
    steps: 25,
    regression: 10,
};
/// Longest recording to learn from, s.
const LESSON_SECONDS: f64 = 8.0;
/// What the ranking is to work with.
pub struct Work<'a> {
    /// What may be the truth; at least two.
    pub hypotheses: &'a [Hypothesis],
    /// Drive, encoder and motor.
    pub setup: Setup,
    /// What may be asked of the motor.
    pub limits: Limits,
    /// Length of the excitation, s.
    pub seconds: f64,
    /// Seed of telegraphs.
    pub seed: u64,
    /// Ends the work early.
    pub stop: &'a AtomicBool,
    /// Told of each candidate that was screened or refitted.
    pub done: &'a (dyn Fn() + Sync),
}

/// A candidate with its separations.
#[derive(Clone, Debug)]
pub struct Ranked {
    /// The excitation, within the limits.
    pub excitation: Excitation,
    /// What it asks for.
    pub usage: Usage,
    /// Of each ordered pair that can be told apart.
    pub separations: Vec<Separation>,
    /// How many of the efforts were made.
    efforts: usize,
}

impl Ranked {
    /// The least separation of all pairs, counts.
    pub fn least(&self) -> f64 {
        let counts = self.separations.iter().map(|pair| pair.counts);
        counts.fold(f64::INFINITY, f64::min)
    }
}

/// How many candidates there are to screen.
pub fn screened(work: &Work<'_>) -> usize {
    all(&frame(work)).len()
}

/// The best candidates within the limits, best first.
///
/// # Errors
/// [`Error::Failed`] where no candidate keeps to the limits, or the user stopped before one was
/// ranked; a hypothesis that is no possible model.
pub fn rank(work: &Work<'_>) -> Result<Vec<Ranked>, Error> {
    let candidates = all(&frame(work));
    let pairs = imitations(work)?;
    let admitted: Vec<Option<Ranked>> = candidates
        .par_iter()
        .map(|candidate| admitted(work, candidate, &pairs))
        .collect::<Result<_, ModelError>>()?;
    let mut ranked: Vec<Ranked> = admitted.into_iter().flatten().collect();
    if ranked.is_empty() {
        return Err(Error::Failed(beyond_limits(work)));
    }
    while !stopped(work) {
        sort(&mut ranked);
        let next = next(&ranked);
        if next.is_empty() {
            break;
        }
        let refitted: Vec<(usize, Ranked)> = next
            .into_par_iter()
            .map(|k| refitted(work, &ranked[k]).map(|refitted| (k, refitted)))
            .collect::<Result<_, ModelError>>()?;
        for (k, better) in refitted {
            ranked[k] = better;
        }
    }
    sort(&mut ranked);
    ranked.retain(|candidate| candidate.efforts == EFFORTS.len());
    ranked.truncate(PLACES);
    if ranked.is_empty() {
        return Err(Error::Failed(
            "stopped by the user before any excitation was ranked; nothing was written".to_owned(),
        ));
    }
    Ok(ranked)
}

fn frame(work: &Work<'_>) -> Frame {
    let slowest = |h: &Hypothesis| h.machine.response().a1;
    let response_s = work.hypotheses.iter().map(slowest).fold(0.0, f64::max);
    Frame {
        seconds: work.seconds,
        sample_s: work.setup.sample_s,
        response_s,
        largest: work.limits.largest_command(work.setup.supply_v),
    }
}

/// The pairs, each with the values by which one imitates the other while the bridge is closed.
fn imitations(work: &Work<'_>) -> Result<Vec<Separation>, ModelError> {
    let lesson = Frame {
        seconds: work.seconds.min(LESSON_SECONDS),
        ..frame(work)
    };
    let drive = lesson
        .stretched(&COMMISSIONING, 1.0)
        .drive(work.setup.sample_s, work.seed);
    refitted_pairs(work, &drive, &Separation::pairs(work.hypotheses), LEARNING)
}

fn stopped(work: &Work<'_>) -> bool {
    work.stop.load(Ordering::Relaxed)
}

/// Screens a candidate, if it can be brought within the limits.
fn admitted(
    work: &Work<'_>,
    candidate: &Excitation,
    pairs: &[Separation],
) -> Result<Option<Ranked>, ModelError> {
    if stopped(work) {
        return Ok(None);
    }
    let admitted = (work.limits).admit(candidate, work.hypotheses, &work.setup, work.seed)?;
    let Some((excitation, usage)) = admitted else {
        (work.done)();
        return Ok(None);
    };
    let unknown = Ranked {
        excitation,
        usage,
        separations: pairs.to_vec(),
        efforts: 0,
    };
    refitted(work, &unknown).map(Some)
}

/// The candidate after its next effort; as it was where the user stopped that.
fn refitted(work: &Work<'_>, candidate: &Ranked) -> Result<Ranked, ModelError> {
    let mut candidate = candidate.clone();
    let effort = EFFORTS[candidate.efforts.min(EFFORTS.len() - 1)];
    let drive = (candidate.excitation).drive(work.setup.sample_s, work.seed);
    let separations = refitted_pairs(work, &drive, &candidate.separations, effort)?;
    if stopped(work) {
        return Ok(candidate);
    }
    candidate.separations = separations;
    candidate.efforts += 1;
    (work.done)();
    Ok(candidate)
}

fn refitted_pairs(
    work: &Work<'_>,
    drive: &[Command<f64>],
    pairs: &[Separation],
    effort: Effort,
) -> Result<Vec<Separation>, ModelError> {
    let trial = Trial {
        hypotheses: work.hypotheses,
        setup: &work.setup,
        drive,
        stop: work.stop,
    };
    let refit = |pair: &Separation| trial.refit(pair, effort);
    pairs.par_iter().map(refit).collect()
}

/// The candidates that lack an effort while they stand among the first places.
fn next(sorted: &[Ranked]) -> Vec<usize> {
    (0..sorted.len().min(PLACES))
        .filter(|&k| sorted[k].efforts < EFFORTS.len())
        .collect()
}

/// Largest separation first; candidates that separate alike stay in their order.
fn sort(ranked: &mut [Ranked]) {
    ranked.sort_by(|a, b| b.least().total_cmp(&a.least()));
}

fn beyond_limits(work: &Work<'_>) -> String {
    if stopped(work) {
        return "stopped by the user before any excitation was tried; nothing was written"
            .to_owned();
    }
    let names: Vec<String> = work.hypotheses.iter().map(Hypothesis::name).collect();
    format!(
        "no excitation keeps to the limits under each of {}, at any amplitude: the shaft drifts by itself, or the \
         limits leave no room; raise --travel or --max-current, or shorten --seconds",
        names.join(", ")
    )
}
