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
use servoid_engine::simulation::{Method, replayed};
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
    /// The same while the recording's position loop drives the model towards its targets, counts; `None` where no loop drove the motor.
    pub replay_rms_counts: Option<f64>,
    /// The parameters that this recording has for itself.
    pub own: Vec<OwnParameter>,
}

/// The error of a model on each recording, where more than one is fitted or more than one held out, or a position loop drove any; else none.
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
    let driven = |data: &Data| data.recordings.loops().next().is_some();
    let asks = |data: &Data| several(data) || driven(data);
    if !asks(fitted) && !held_out.is_some_and(asks) {
        return Ok(Vec::new());
    }
    let own = scores::whole(fitted, candidate, method)?;
    let mut all = each(fitted, &own, &replayed(fitted, candidate, method), false);
    if let Some(held_out) = held_out {
        let other = validation_errors(held_out, candidate, method)?;
        all.extend(each(
            held_out,
            &other,
            &replayed(held_out, candidate, method),
            true,
        ));
    }
    Ok(all)
}

/// A motor behind its loop that misses the angle by so many times what it misses along the volts is driven by another loop.
const OTHER_LOOP: f64 = 3.0;
/// And by so many counts at least.
const OTHER_LOOP_COUNTS: f64 = 3.0;

/// What is said of recordings whose loop is not what is known of it: along the volts the model follows them, and behind the loop it does not.
pub fn loop_remarks(recordings: &[RecordingError]) -> impl Iterator<Item = String> {
    recordings.iter().filter_map(|one| {
        let replayed = one.replay_rms_counts?;
        let other = replayed > OTHER_LOOP * one.rms_counts && replayed > OTHER_LOOP_COUNTS;
        other.then(|| {
            format!(
                "{}: driven by its position loop the model misses the angle by {replayed:.1} counts RMS, along the volts by {:.1}: the loop is not \
                 what is said of it (gain, damping, limit, dead band, rate), or a delay lies between its command and the motor",
                one.source, one.rms_counts
            )
        })
    })
}

fn each(
    data: &Data,
    errors: &[f64],
    replayed: &[Option<f64>],
    held_out: bool,
) -> Vec<RecordingError> {
    (data.recordings.ranges().zip(data.recordings.sources()))
        .zip(replayed)
        .map(|((range, source), replayed)| RecordingError {
            source: source.clone(),
            held_out,
            samples: range.len(),
            rms_counts: rms_counts(data, &errors[range]),
            replay_rms_counts: *replayed,
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
