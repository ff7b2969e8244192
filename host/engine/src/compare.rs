//! Search methods side by side: the same problem, the same budget of model evaluations, many seeds.
//! A single run proves nothing (the spread over seeds is often a factor of five), so every figure is
//! a median with its spread.

use crate::block_cost::BlockCost;
use crate::problem::FitProblem;
use crate::solve::{Evaluator, Found, Solver};
use rayon::prelude::*;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The same task for all methods.
pub struct Contest<'a> {
    /// The problem.
    pub problem: &'a FitProblem<'a>,
    /// Model evaluations of each run.
    pub budget: usize,
    /// One run of each method for each seed.
    pub seeds: Vec<u64>,
}

/// The runs of one method.
#[derive(Clone, Debug)]
pub struct Row {
    /// The method.
    pub algorithm: String,
    /// Its runs, in the order of the seeds.
    pub runs: Vec<Found>,
    /// Computing time of all runs together, s.
    pub wall_s: f64,
}

/// Points of a cost curve.
const CURVE_POINTS: usize = 60;

/// Runs every method for every seed, on all cores; the result does not depend on their number. Runs
/// that had not begun when the user stopped the work are left out.
pub fn run(
    contest: &Contest<'_>,
    solvers: &[Box<dyn Solver>],
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Vec<Row> {
    let quick = BlockCost::new(contest.problem);
    solvers
        .iter()
        .map(|solver| {
            let timed: Vec<(Found, f64)> = contest
                .seeds
                .par_iter()
                .map(|&seed| {
                    let began = Instant::now();
                    let mut nobody = |_: usize, _: f64| {};
                    let mut evaluator = Evaluator::new(&quick, contest.budget, stop, &mut nobody);
                    solver.search(&mut evaluator, seed);
                    done();
                    (evaluator.finish(), began.elapsed().as_secs_f64())
                })
                .collect();
            Row {
                algorithm: solver.name().to_owned(),
                wall_s: timed.iter().map(|(_, seconds)| seconds).sum(),
                runs: timed
                    .into_iter()
                    .map(|(found, _)| found)
                    .filter(|found| found.evaluations > 0)
                    .collect(),
            }
        })
        .collect()
}

impl Row {
    /// Best costs of the runs, ascending.
    pub fn costs(&self) -> Vec<f64> {
        let mut costs: Vec<f64> = self.runs.iter().map(|run| run.cost).collect();
        costs.sort_by(f64::total_cmp);
        costs
    }

    /// The best of all runs; none if no run found a finite cost.
    pub fn best(&self) -> Option<&Found> {
        let best = self.runs.iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        best.filter(|run| run.cost.is_finite())
    }

    /// The run whose cost is the median: what to expect; none if that cost is not finite.
    pub fn typical(&self) -> Option<&Found> {
        let mut runs: Vec<&Found> = self.runs.iter().collect();
        runs.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let median = runs.get(runs.len().saturating_sub(1) / 2).copied();
        median.filter(|run| run.cost.is_finite())
    }

    /// Evaluations that each run took to `target`, ascending; infinite for those that never got there.
    pub fn evaluations_to(&self, target: f64) -> Vec<f64> {
        let mut counts: Vec<f64> = self
            .runs
            .iter()
            .map(|run| {
                let reached = run.curve.iter().find(|(_, cost)| *cost <= target);
                reached.map_or(f64::INFINITY, |(count, _)| *count as f64)
            })
            .collect();
        counts.sort_by(f64::total_cmp);
        counts
    }

    /// Their median; `None` if more than half of the runs never got there.
    pub fn median_evaluations_to(&self, target: f64) -> Option<f64> {
        Some(quantile(&self.evaluations_to(target), 0.5)).filter(|median| median.is_finite())
    }

    /// Quantile `q` over the runs of the best cost after each of a list of evaluation counts.
    pub fn curve(&self, budget: usize, q: f64) -> Vec<(usize, f64)> {
        let points = CURVE_POINTS.min(budget);
        let ratio = libm::pow(budget as f64, 1.0 / points.max(1) as f64);
        let mut counts: Vec<usize> = (0..=points)
            .map(|k| ratio.powi(k as i32).round() as usize)
            .collect();
        counts.dedup();
        counts
            .into_iter()
            .map(|count| {
                let mut costs: Vec<f64> =
                    self.runs.iter().map(|run| cost_after(run, count)).collect();
                costs.sort_by(f64::total_cmp);
                (count, quantile(&costs, q))
            })
            .collect()
    }
}

fn cost_after(run: &Found, evaluations: usize) -> f64 {
    let last = run
        .curve
        .iter()
        .take_while(|(count, _)| *count <= evaluations)
        .last();
    last.map_or(f64::INFINITY, |(_, cost)| *cost)
}

/// Quantile of sorted values, linear between neighbours; NaN of none.
pub fn quantile(sorted: &[f64], q: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = q * last as f64;
    let below = place.floor() as usize;
    let (a, b) = (sorted[below], sorted[(below + 1).min(last)]);
    // Between a number and infinity there is nothing to interpolate.
    if a == b || !b.is_finite() {
        return if place > below as f64 { b } else { a };
    }
    a + (b - a) * (place - below as f64)
}
