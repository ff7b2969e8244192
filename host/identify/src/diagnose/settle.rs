//! The model that a diagnosis ends with, fitted to its end: parameters with intervals.

use super::models::{FittedModel, NOISE_COUNTS};
use super::outcome::Diagnosis;
use crate::diagnose::settings::BUDGET;
use crate::error::Error;
use crate::fit::{self, Fit, Options, Parameter};
use servoid_engine::problem::{Data, FitProblem, Horizon, StartAngle};
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use servoid_engine::solve::{Found, Objective};
use shared::cost::Cost;
use std::sync::atomic::{AtomicBool, Ordering};

/// Fits the last model to its end and says what is known of its parameters. A model that is not judged by its
/// free run over the readings as they are (in windows, with lost counts put back) stays where it is. So does one
/// whose free run is chaotic, unless it is near enough to get down to the encoder's own error: elsewhere the free
/// run's cost has no smooth floor.
///
/// # Errors
/// Where the model cannot run, which it could before.
pub fn settle(
    diagnosis: &Diagnosis,
    data: &Data,
    held_out: &Data,
    options: &Options,
    stop: &AtomicBool,
) -> Result<Fit, Error> {
    let last = &diagnosis.last;
    let options = Options {
        effects: last.effects.clone(),
        method: last.method,
        budget: BUDGET,
        ..options.clone()
    };
    let start = last.x.clone();
    let problem = FitProblem {
        data,
        structure: last.structure.clone(),
        cost: Cost::Squared,
        weight: 1.0,
        horizon: Horizon::Whole,
        start_angle: StartAngle::Free,
        method: last.method,
        start: Some(start.clone()),
    };
    let judged_otherwise =
        last.windowed.is_some() || last.losses.is_some() || diagnosis.predicts.is_some();
    let chaotic = last.observed.is_some() && !last.ran().at_floor();
    // As far as it was followed it was fitted to its end.
    let followed = last.followed_fraction > 0.0;
    let stays = judged_otherwise || followed || diagnosis.ran_out || stop.load(Ordering::Relaxed);
    let found = (!stays)
        .then(|| {
            let solver = LevenbergMarquardt::default();
            fit::search(&problem, &solver, &options, stop, &mut |_, _| {})
        })
        .filter(|found| found.cost.is_finite())
        .filter(|found| !chaotic || (found.cost / data.len() as f64).sqrt() < NOISE_COUNTS);
    let found = found.unwrap_or_else(|| Found {
        cost: problem.cost(&start),
        x: start,
        evaluations: 0,
        curve: Vec::new(),
        interrupted: false,
    });
    let mut fit = Fit::conclude(&problem, "lm", "squared", &found, &options, Some(held_out))?;
    if last.losses.is_some() {
        with_losses(&mut fit, last);
    }
    if stays && !last.standard_errors.is_empty() {
        with_standard_errors(&mut fit, last);
    }
    Ok(fit)
}

/// The standard errors that a score gave, in the units in which the fit states its parameters.
fn with_standard_errors(fit: &mut Fit, last: &FittedModel) {
    fit.converged = true;
    let values = last.structure.values(&last.x);
    let unknowns = last.structure.unknowns.iter().zip(values);
    for (unknown, value) in unknowns {
        let stated = fit.parameters.iter_mut().find(|p| p.name == unknown.name);
        let std = last.standard_errors.get(&unknown.name);
        if let Some(parameter) = stated {
            let scale = if value == 0.0 {
                1.0
            } else {
                parameter.value / value
            };
            parameter.set_std(std.map(|std| (std * scale).abs()));
        }
    }
}

/// Errors with the lost counts put back, and the parameters of the loss, whose errors are not known.
fn with_losses(fit: &mut Fit, last: &FittedModel) {
    fit.rms_counts = last.rms_counts;
    fit.validate_rms_counts = Some(last.validate_rms_counts);
    fit.effects = last.effects.iter().map(|kind| kind.name()).collect();
    let mut values = last.parameters.iter();
    for kind in &last.effects {
        for parameter in kind.parameters() {
            let Some(&value) = values.next() else { return };
            if kind.facts().by_chance {
                let name = format!("{}.{}", kind.name(), parameter.name);
                let unit = parameter.quantity.unit();
                fit.parameters
                    .push(Parameter::without_error(name, value, unit));
            }
        }
    }
}
