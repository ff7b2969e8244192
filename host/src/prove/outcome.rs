//! The diagnosis of one case beside its truth.

use super::SetUp;
use super::case::{Case, Drawn};
use super::draws::rounded;
use super::law::FoundLaw;
use crate::error::Error;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Data;
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use servoid_identify::diagnose::{Budget, Diagnosis, FittedModel};
use servoid_identify::discovery;
use servoid_identify::fit::{self, Options};
use servoid_identify::truth::{self, ParameterError};
use servoid_results::schema::diagnosis::Hypothesis;
use shared::effects::Kind;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// An effect that leaves less than this after the linear motor is fitted is not there to be found,
/// counts RMS.
pub const DETECTABLE_COUNTS: f64 = 1.0;

/// RMS errors of a model, counts; none where it is not a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// On the fitted recording.
    pub fitted: Option<f64>,
    /// On the held-out recording.
    pub held_out: Option<f64>,
}

/// One effect that the diagnosis names.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Naming {
    /// The effect.
    pub effect: String,
    /// Effects that it says explain the recording as well.
    pub alike: Vec<String>,
}

/// A finished case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Seed of the set-up.
    pub seed: u64,
    /// Number of the case.
    pub case: u64,
    /// What was drawn.
    #[serde(flatten)]
    pub drawn: Drawn,
    /// Errors of the linear motor.
    pub base: Errors,
    /// Whether every hidden effect leaves more than [`DETECTABLE_COUNTS`] once the linear motor is
    /// fitted. Where there is no diagnosis this is taken to be so.
    pub detectable: bool,
    /// What each hidden effect leaves, on its own in the same motor under the same drive, counts RMS.
    pub alone: Vec<Option<f64>>,
    /// What the diagnosis names, in its order.
    pub named: Vec<Naming>,
    /// Sets of effects that it holds for possible, with their probabilities.
    #[serde(default)]
    pub hypotheses: Vec<Hypothesis>,
    /// Its verdict; `failed` where there is none.
    pub verdict: String,
    /// Errors of its model.
    pub last: Errors,
    /// Errors of the parameters of the effects that it names rightly.
    pub parameters: Vec<ParameterError>,
    /// Model evaluations, where the diagnosis counts them.
    pub evaluations: Option<u64>,
    /// Steps of a model that it took.
    #[serde(default)]
    pub steps: Option<u64>,
    /// Whether those that it may take did not suffice.
    #[serde(default)]
    pub ran_out: bool,
    /// Times that it reported progress: candidates refitted.
    pub refits: u64,
    /// Time that it took in one thread, s.
    pub seconds: f64,
    /// What was found of a law outside the catalogue, where laws were looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law_found: Option<FoundLaw>,
    /// Why there is no diagnosis.
    pub failure: Option<String>,
}

impl Outcome {
    /// Diagnoses a case in one thread.
    ///
    /// # Errors
    /// Where no thread can be made. A diagnosis that fails is an outcome too.
    pub fn of(case: &Case, set_up: &SetUp, stop: &AtomicBool) -> Result<Outcome, Error> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .map_err(|error| Error::Failed(format!("no thread for a case: {error}")))?;
        let refits = AtomicU64::new(0);
        let count = || {
            refits.fetch_add(1, Ordering::Relaxed);
        };
        let options = Options {
            discover: set_up.discover,
            ..Options::default()
        };
        let began = Instant::now();
        // A fault of the diagnosis in one case of a thousand must not lose the others.
        let diagnosed = catch_unwind(AssertUnwindSafe(|| {
            pool.install(|| {
                let budget = Budget::usual(stop);
                discovery::search_with_laws(&case.fitted, &case.held_out, &options, &budget, &count)
            })
        }));
        let outcome = Outcome {
            seed: set_up.seed,
            case: case.number,
            drawn: case.drawn.clone(),
            base: Errors::default(),
            detectable: true,
            alone: Vec::new(),
            named: Vec::new(),
            hypotheses: Vec::new(),
            verdict: "failed".to_owned(),
            last: Errors::default(),
            parameters: Vec::new(),
            evaluations: None,
            steps: None,
            ran_out: false,
            refits: refits.load(Ordering::Relaxed),
            seconds: rounded(began.elapsed().as_secs_f64()),
            law_found: None,
            failure: None,
        };
        match diagnosed {
            Ok(Ok((diagnosis, proposed))) => {
                let proposed = proposed.unwrap_or_default();
                let found = || FoundLaw::of(case, &diagnosis.last, &proposed);
                let law_found = set_up.discover.then(found);
                let outcome = outcome.with(&diagnosis, stop)?;
                Ok(Outcome {
                    law_found,
                    ..outcome
                })
            }
            Ok(Err(error)) => Ok(outcome.failed(error.to_string())),
            Err(fault) => Ok(outcome.failed(format!("the diagnosis panicked: {}", said(&*fault)))),
        }
    }

    /// Whether this program draws the case in the same way.
    pub fn is_drawn_from(&self, set_up: &SetUp) -> bool {
        self.seed == set_up.seed
            && Drawn::draw(set_up, self.case, self.drawn.redrawn)
                .is_ok_and(|drawn| drawn == self.drawn)
    }

    fn failed(self, reason: String) -> Outcome {
        Outcome {
            failure: Some(reason),
            ..self
        }
    }

    fn with(self, diagnosis: &Diagnosis, stop: &AtomicBool) -> Result<Outcome, Error> {
        let names = |kinds: &[Kind]| kinds.iter().map(|kind| kind.name().to_owned()).collect();
        let named = diagnosis.steps.iter().map(|step| Naming {
            effect: step.added.name().to_owned(),
            alike: names(&step.indistinguishable_from),
        });
        let base = Errors::of(&diagnosis.base);
        let alone = match &self.drawn.apart()[..] {
            [] => Vec::new(),
            [_] => vec![base.fitted],
            several => several.iter().map(|alone| leaves(alone, stop)).collect(),
        };
        let leaves_much = |rms: &Option<f64>| rms.is_some_and(|rms| rms > DETECTABLE_COUNTS);
        Ok(Outcome {
            base,
            detectable: alone.iter().all(leaves_much),
            alone,
            named: named.collect(),
            hypotheses: diagnosis.hypotheses.iter().map(Into::into).collect(),
            verdict: diagnosis.verdict.name().to_owned(),
            last: Errors::of(&diagnosis.last),
            parameters: parameter_errors(&self.drawn, &diagnosis.last)?,
            steps: Some(diagnosis.steps_taken),
            ran_out: diagnosis.ran_out,
            ..self
        })
    }
}

impl Errors {
    fn of(refit: &FittedModel) -> Errors {
        Errors {
            fitted: finite(refit.rms_counts),
            held_out: finite(refit.validate_rms_counts),
        }
    }
}

/// Six digits of a finite number.
fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite()).map(rounded)
}

/// What a panic said.
fn said(fault: &(dyn Any + Send)) -> &str {
    let text = fault.downcast_ref::<String>().map(String::as_str);
    text.or(fault.downcast_ref::<&str>().copied())
        .unwrap_or("without a word")
}

/// Error of the linear motor, counts RMS; `None` where the motor cannot be recorded or fitted.
fn leaves(drawn: &Drawn, stop: &AtomicBool) -> Option<f64> {
    let linear = |data: &Data| -> Result<f64, Error> {
        let options = Options::default();
        let problem = fit::problem(data, &options)?;
        let solver = LevenbergMarquardt::default();
        let found = fit::search(&problem, &solver, &options, stop, &mut |_, _| {});
        let values = problem.structure.values(&found.x);
        let candidate = problem.structure.candidate(&values);
        Ok(fit::validate(data, &candidate, options.method)?)
    };
    finite(linear(&drawn.data(0).ok()?).ok()?)
}

/// Errors of the parameters of the effects that are both hidden and in the model.
fn parameter_errors(drawn: &Drawn, model: &FittedModel) -> Result<Vec<ParameterError>, Error> {
    let machine = drawn.motor.machine;
    let mut rest = &model.parameters[..];
    let mut errors = Vec::new();
    let hidden = drawn.hidden()?;
    for &kind in &model.effects {
        let Some((found, further)) = rest.split_at_checked(kind.parameters().len()) else {
            break;
        };
        rest = further;
        let truth = hidden
            .iter()
            .find(|hidden| hidden.name() == kind.name())
            .map(|hidden| hidden.truth(&machine, drawn.counts_per_rev));
        if let Some(truth) = truth {
            errors.extend(truth::errors(kind, found, &truth));
        }
    }
    for error in &mut errors {
        error.percent = rounded(error.percent);
    }
    Ok(errors)
}
