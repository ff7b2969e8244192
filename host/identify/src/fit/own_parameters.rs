//! Recordings of one motor with parameters of their own beside the common ones: another amplifier's offset, another logger's
//! delay, a warmer winding. One least-squares fit has the common unknowns once and the others once a recording.

mod together;

use super::options::Options;
use super::recordings::standard_deviation;
use super::report::{Fit, Solved};
use crate::error::Error;
use servoid_engine::problem::{
    Candidate, Data, FitProblem, Horizon, START_OFFSET, START_SPEED, Structure,
};
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use servoid_engine::solve::{Evaluator, Found, Solver};
use servoid_io::input::suggest::did_you_mean;
use shared::cost::Cost;
use std::sync::atomic::AtomicBool;
use together::Together;

/// A parameter that one recording has for itself.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnParameter {
    /// Name, as among the fit's parameters.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// Unit symbol.
    pub unit: &'static str,
    /// Standard error; `None` where the recording does not determine it.
    pub std: Option<f64>,
}

/// Recordings that were fitted together, with parameters of their own.
pub struct OwnFit {
    /// Where the search ended; of what the recordings have for themselves, the mean.
    pub found: Found,
    /// The common model's unknowns there.
    pub solved: Solved,
    /// What each recording has for itself.
    pub recordings: OwnParameters,
}

/// What each recording has for itself.
pub struct OwnParameters {
    /// A list for each recording.
    own: Vec<Vec<OwnParameter>>,
    /// RMS error of each recording, counts.
    rms_counts: Vec<f64>,
}

impl OwnParameters {
    /// Writes each recording's parameters and error into a `fit` of the common model, and how far the recordings differ.
    pub fn write_into(&self, fit: &mut Fit) {
        let fitted = fit.recordings.iter_mut().filter(|one| !one.held_out);
        for ((recording, own), rms) in fitted.zip(&self.own).zip(&self.rms_counts) {
            recording.own.clone_from(own);
            recording.rms_counts = *rms;
        }
        for (k, own) in self.own.first().into_iter().flatten().enumerate() {
            let values: Vec<f64> = self.own.iter().map(|all| all[k].value).collect();
            let named = fit.parameters.iter_mut().filter(|p| p.name == own.name);
            for parameter in named.filter(|p| p.unit == own.unit) {
                parameter.spread = Some(standard_deviation(&values));
            }
        }
        let names: Vec<&str> = (self.own.first().into_iter().flatten())
            .map(|own| own.name.as_str())
            .collect();
        fit.notes.insert(0, format!(
            "each recording has its own {}: the value among the parameters is their mean, which every held-out recording is \
             predicted with",
            names.join(" and ")
        ));
    }
}

/// Refuses what cannot be searched for in each recording.
///
/// # Errors
/// [`Error::Usage`] for one recording, for another cost than squares, and for a name that is no unknown of the model.
pub fn check(problem: &FitProblem<'_>, options: &Options) -> Result<(), Error> {
    let Some(first) = options.own.first() else {
        return Ok(());
    };
    if !problem.data.recordings.are_several() {
        return Err(Error::Usage(format!(
            "--own {first}: with one recording every parameter is its own; give several recordings of the motor"
        )));
    }
    if problem.cost != Cost::Squared {
        return Err(Error::Usage(format!(
            "--own {first}: parameters of each recording are fitted by least squares; leave out --cost"
        )));
    }
    let names: Vec<&str> = (problem.structure.unknowns.iter())
        .map(|unknown| unknown.name.as_str())
        .filter(|name| !is_start(name))
        .collect();
    for name in &options.own {
        if !names.contains(&name.as_str()) {
            return Err(Error::Usage(format!(
                "--own {name}: not an unknown of this model; {}",
                did_you_mean(name, &names)
            )));
        }
    }
    Ok(())
}

/// Fits the recordings of `problem` from where the search for common unknowns ended.
///
/// # Errors
/// [`Error::Failed`] where the model cannot run along one of the recordings.
pub fn fit_own(
    problem: &FitProblem<'_>,
    common: &Found,
    options: &Options,
    stop: &AtomicBool,
) -> Result<OwnFit, Error> {
    let parts: Vec<Data> = problem.data.parts().collect();
    let candidate = problem.structure.candidate_at(&common.x);
    let structure = structure(problem, &candidate, &parts);
    let start = structure.point(&candidate);
    let together = Together::new(&parts, problem, structure, &start, options);
    let mut observer = |_, _| ();
    let mut evaluator = Evaluator::new(&together, options.budget, stop, &mut observer);
    LevenbergMarquardt::default().search(&mut evaluator, options.seed);
    let found = evaluator.finish();
    let (solved, recordings) = together.concluded(problem, &found.x).ok_or_else(|| {
        Error::Failed(format!(
            "--own {}: the model cannot run along one of the recordings with it; fit that recording alone to see why",
            options.own.join(",")
        ))
    })?;
    Ok(OwnFit {
        found: Found {
            x: problem.structure.coordinates(&solved.values),
            evaluations: common.evaluations + found.evaluations,
            interrupted: common.interrupted || found.interrupted,
            ..found
        },
        solved,
        recordings,
    })
}

/// Whether an unknown describes the begin of a recording, which each has for itself anyway.
fn is_start(name: &str) -> bool {
    name == START_SPEED || name == START_OFFSET
}

/// The unknowns of the common fit, and the speed at the first sample where a recording may start in motion.
fn structure(problem: &FitProblem<'_>, candidate: &Candidate, parts: &[Data]) -> Structure {
    let common = &problem.structure;
    let windows = matches!(problem.horizon, Horizon::Windows(_));
    let moving = !windows && parts.iter().any(|part| part.may_start_moving(0));
    let mut structure = Structure::around(
        problem.data,
        common.base,
        &common.effects,
        &candidate.machine,
        moving || common.start_speed,
    );
    for unknown in &mut structure.unknowns {
        if let Some(known) = common.unknowns.iter().find(|u| u.name == unknown.name) {
            unknown.clone_from(known);
        }
    }
    structure
}
