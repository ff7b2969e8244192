//! Several recordings of one motor: the error on each, and how far the parameters spread that each alone gives.

use super::options::Options;
use super::own_parameters::OwnParameter;
use super::report::Fit;
use super::scores;
use super::search::search;
use super::start::problem;
use super::validate::validation_errors;
use crate::error::Error;
use servoid_engine::problem::{Candidate, Data, rms_counts};
use servoid_engine::simulation::Method;
use servoid_engine::solve;
use std::sync::atomic::AtomicBool;

/// The error of a model on one of several recordings.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingError {
    /// Where the recording came from.
    pub source: String,
    /// Whether it was held out.
    pub held_out: bool,
    /// Number of samples.
    pub samples: usize,
    /// RMS of model minus reading over the whole recording, counts.
    pub rms_counts: f64,
    /// The parameters that this recording has for itself.
    pub own: Vec<OwnParameter>,
}

/// The error of a model on each recording, where more than one is fitted or more than one held out; else none.
///
/// # Errors
/// Where the model cannot run.
pub fn recording_errors(
    fitted: &Data,
    held_out: Option<&Data>,
    candidate: &Candidate,
    method: Method,
) -> Result<Vec<RecordingError>, Error> {
    let several = |data: &Data| data.recordings.are_several();
    if !several(fitted) && !held_out.is_some_and(several) {
        return Ok(Vec::new());
    }
    let own = scores::whole(fitted, candidate, method)?;
    let mut all = each(fitted, &own, false);
    if let Some(held_out) = held_out {
        let other = validation_errors(held_out, candidate, method)?;
        all.extend(each(held_out, &other, true));
    }
    Ok(all)
}

fn each(data: &Data, errors: &[f64], held_out: bool) -> Vec<RecordingError> {
    (data.recordings.ranges().zip(data.recordings.sources()))
        .map(|(range, source)| RecordingError {
            source: source.clone(),
            held_out,
            samples: range.len(),
            rms_counts: rms_counts(data, &errors[range]),
            own: Vec::new(),
        })
        .collect()
}

/// Fewest recordings from which a spread is taken.
const FEWEST: usize = 3;
/// A spread so many standard errors wide is more than chance.
const BEYOND: f64 = 2.0;

/// Fits each recording alone from the common model and gives each parameter the standard deviation of its values: what
/// differs from run to run is no error that one recording could show.
pub fn add_spread(fit: &mut Fit, data: &Data, options: &Options, stop: &AtomicBool) {
    let Some(solver) = solve::by_name(&options.algorithm) else {
        return;
    };
    if data.recordings.count() < FEWEST || fit.interrupted {
        return;
    }
    let alone: Vec<Vec<(String, f64)>> = data
        .parts()
        .filter_map(|part| {
            let problem = problem(&part, options).ok()?.begun_at(&fit.candidate);
            let found = search(&problem, solver.as_ref(), options, stop, &mut |_, _| ());
            let values = problem.structure.values(&found.x);
            let names = problem.structure.unknowns.iter().map(|u| u.name.clone());
            found.cost.is_finite().then(|| names.zip(values).collect())
        })
        .collect();
    if alone.len() < FEWEST {
        return;
    }
    let mut wide = Vec::new();
    for parameter in &mut fit.parameters {
        let values: Vec<f64> = alone
            .iter()
            .flat_map(|list| list.iter().filter(|(name, _)| *name == parameter.name))
            .map(|&(_, value)| value)
            .collect();
        // A torque that known facts turned into N·m has no spread in volts.
        if values.len() < FEWEST || parameter.unit == "N*m" {
            continue;
        }
        let spread = standard_deviation(&values);
        parameter.spread = Some(spread);
        let of_mean = spread / (values.len() as f64).sqrt();
        if parameter.std.is_some_and(|std| of_mean > BEYOND * std) {
            wide.push(format!(
                "{} ({:.1} %)",
                parameter.name,
                100.0 * spread / parameter.value.abs().max(f64::MIN_POSITIVE)
            ));
        }
    }
    if !wide.is_empty() {
        fit.notes.push(format!(
            "between recordings these differ by more than their standard errors tell: {}; believe the spread",
            wide.join(", ")
        ));
    }
}

/// Of values of a sample.
pub(super) fn standard_deviation(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / (n - 1.0)).sqrt()
}
