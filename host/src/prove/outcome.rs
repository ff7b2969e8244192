//! The diagnosis of one case beside its truth.

use super::case::{Case, Drawn};
use super::{SetUp, hide};
use crate::diagnose::{self, Diagnosis};
use crate::error::Error;
use crate::fit::Options;
use serde::{Deserialize, Serialize};
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
    /// Whether the linear motor leaves more than [`DETECTABLE_COUNTS`] on the fitted recording.
    pub detectable: bool,
    /// What the diagnosis names, in its order.
    pub named: Vec<Naming>,
    /// Its verdict; `failed` where there is none.
    pub verdict: String,
    /// Errors of its model.
    pub last: Errors,
    /// Candidates refitted.
    pub refits: u64,
    /// Time that the diagnosis took in one thread, s.
    pub seconds: f64,
    /// Why there is no diagnosis.
    pub failure: Option<String>,
}

/// Diagnoses a case in one thread.
///
/// # Errors
/// Where no thread can be made. A diagnosis that fails is an outcome too.
pub fn prove(case: &Case, set_up: &SetUp, stop: &AtomicBool) -> Result<Outcome, Error> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .map_err(|error| Error::Failed(format!("no thread for a case: {error}")))?;
    let refits = AtomicU64::new(0);
    let began = Instant::now();
    let diagnosed = catch_unwind(AssertUnwindSafe(|| {
        pool.install(|| {
            diagnose::diagnose(
                &case.fitted,
                &case.held_out,
                &Options::default(),
                stop,
                &|| {
                    refits.fetch_add(1, Ordering::Relaxed);
                },
            )
        })
    }));
    let outcome = Outcome {
        seed: set_up.seed,
        case: case.number,
        drawn: case.drawn.clone(),
        base: Errors::default(),
        detectable: false,
        named: Vec::new(),
        verdict: "failed".to_owned(),
        last: Errors::default(),
        refits: refits.into_inner(),
        seconds: began.elapsed().as_secs_f64(),
        failure: None,
    };
    Ok(match diagnosed {
        Ok(Ok(diagnosis)) => outcome.with(&diagnosis),
        Ok(Err(error)) => outcome.failed(error.to_string()),
        // A fault of the diagnosis in one case in a thousand must not lose the others.
        Err(fault) => outcome.failed(format!("the diagnosis panicked: {}", said(&*fault))),
    })
}

/// What a panic said.
fn said(fault: &(dyn Any + Send)) -> &str {
    let text = fault.downcast_ref::<String>().map(String::as_str);
    text.or(fault.downcast_ref::<&str>().copied())
        .unwrap_or("without a word")
}

impl Outcome {
    fn failed(self, reason: String) -> Outcome {
        Outcome {
            failure: Some(reason),
            ..self
        }
    }

    fn with(self, diagnosis: &Diagnosis) -> Outcome {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let errors = |refit: &diagnose::Refit| Errors {
            fitted: finite(refit.rms_counts),
            held_out: finite(refit.validate_rms_counts),
        };
        let named = diagnosis.steps.iter().map(|step| Naming {
            effect: step.added.name().to_owned(),
            alike: step
                .indistinguishable_from
                .iter()
                .map(|kind| kind.name().to_owned())
                .collect(),
        });
        Outcome {
            base: errors(&diagnosis.base),
            detectable: diagnosis.base.rms_counts > DETECTABLE_COUNTS,
            named: named.collect(),
            verdict: diagnosis.verdict.name().to_owned(),
            last: errors(&diagnosis.last),
            ..self
        }
    }

    /// Whether the first effect named is a hidden one.
    pub fn right_first(&self) -> bool {
        let first = self.named.first();
        first.is_some_and(|naming| self.drawn.names().contains(&naming.effect.as_str()))
    }

    /// Whether a hidden effect is the first one named, or among those that are said to look like it.
    pub fn right_in_set(&self) -> bool {
        self.named
            .first()
            .is_some_and(|naming| self.drawn.names().iter().any(|name| naming.covers(name)))
    }

    /// Whether more than the first effect is named, and the second is no hidden one.
    pub fn spurious_second(&self) -> bool {
        self.wrong_names()
            .any(|name| Some(name) != self.named.first().map(|n| n.effect.as_str()))
    }

    /// The hidden effects that are named.
    pub fn right_names(&self) -> usize {
        let named = |name: &&str| self.named.iter().any(|naming| naming.effect == *name);
        self.drawn.names().iter().filter(|name| named(name)).count()
    }

    /// Names that are no hidden effect.
    pub fn wrong_names(&self) -> impl Iterator<Item = &str> {
        let hidden = self.drawn.names();
        let names = self.named.iter().map(|naming| naming.effect.as_str());
        names.filter(move |name| !hidden.contains(name))
    }

    /// Names that are no hidden effect, nor a declared look-alike of one.
    pub fn quite_wrong_names(&self) -> impl Iterator<Item = &str> {
        let hidden = self.drawn.names();
        self.wrong_names()
            .filter(move |name| hidden.iter().all(|truth| hide::acts_otherwise(name, truth)))
    }
}

impl Naming {
    /// Whether it says `name`, or that `name` explains the recording as well.
    pub fn covers(&self, name: &str) -> bool {
        self.effect == name || self.alike.iter().any(|alike| alike == name)
    }
}
