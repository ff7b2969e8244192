//! The error ladder: the error as effects are added one by one.

use super::options::Options;
use super::report::{Fit, LadderEntry};
use super::search::search;
use super::start::problem;
use servoid_engine::problem::Data;
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most evaluations of one intermediate model.
const BUDGET: usize = 2000;

/// Errors from the linear motor up to `fit`, in the order in which `options` name the effects. Models on the way
/// are fitted by least squares, whatever method found `fit`; one that cannot be fitted is left out.
pub fn error_ladder(
    data: &Data,
    validation: Option<&Data>,
    fit: &Fit,
    options: &Options,
    stop: &AtomicBool,
) -> Vec<LadderEntry> {
    let mut entries = Vec::new();
    for many in 0..options.effects.len() {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let options = Options {
            effects: options.effects[..many].to_vec(),
            budget: options.budget.min(BUDGET),
            ..options.clone()
        };
        let Ok(problem) = problem(data, &options) else {
            continue;
        };
        let solver = LevenbergMarquardt::default();
        let found = search(&problem, &solver, &options, stop, &mut |_, _| {});
        if let Ok(fit) = Fit::conclude(&problem, "lm", "squared", &found, &options, validation) {
            entries.push(entry(&fit));
        }
    }
    entries.push(entry(fit));
    entries
}

fn entry(fit: &Fit) -> LadderEntry {
    LadderEntry {
        added: fit.effects.last().copied(),
        rms_counts: fit.rms_counts,
        validate_rms_counts: fit.validate_rms_counts,
    }
}
