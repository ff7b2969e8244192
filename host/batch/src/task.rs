//! What is done to each recording.

use crate::input::{Content, Unit};
use crate::key::key;
use crate::row::{ERROR, OK, Parameter, Row};
use serde::{Deserialize, Serialize};
use servoid_identify::diagnose::Budget;
use servoid_identify::fit::{Options, cost_by_name, effects_by_name};
use servoid_identify::{Datasets, FitSets, Progress, diagnose_datasets};
use servoid_io::input::{MotorFile, read_recording_from};
use servoid_io::recording::Recording;
use servoid_results::report::diagnosis::DiagnosisReport;
use servoid_results::schema::{self, Estimate};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Verb {
    /// A model is fitted.
    Fit,
    /// The missing effects are named.
    Diagnose,
}

/// What is done to each recording, with everything that the result depends on. Bounds are in model steps and evaluations: the
/// result is the same on every machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// What is done.
    pub verb: Verb,
    /// Effects of a fit beside the linear motor.
    pub effects: Vec<String>,
    /// Search method of a fit.
    pub algorithm: String,
    /// What a fit minimises.
    pub cost: String,
    /// Model evaluations of a fit at most.
    pub evaluations: usize,
    /// Steps of a model that a diagnosis takes at most.
    pub steps: u64,
    /// Seed of everything random.
    pub seed: u64,
    /// Whether recordings are used that the check refuses.
    pub force: bool,
}

/// Why a recording gives no result.
struct Fault {
    cause: &'static str,
    message: String,
}

impl Fault {
    fn of(cause: &'static str, message: impl std::fmt::Display) -> Self {
        Fault {
            cause,
            message: message.to_string(),
        }
    }
}

impl From<servoid_identify::Error> for Fault {
    fn from(error: servoid_identify::Error) -> Self {
        Fault::of(error.cause(), error)
    }
}

/// What came of a recording.
#[derive(Default)]
struct Found {
    verdict: Option<String>,
    effects: Vec<String>,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
    parameters: Vec<Parameter>,
    result: Option<String>,
    interrupted: bool,
}

impl Task {
    /// Whether it can be done at all, before the first recording is read.
    ///
    /// # Errors
    /// An effect, cost or method that there is none of, in words.
    pub fn check(&self) -> Result<(), servoid_identify::Error> {
        self.options(MotorFile::default())?;
        Ok(())
    }

    /// As JSON, as rows hold it.
    pub fn text(&self) -> String {
        // Nothing in it can fail to be written.
        serde_json::to_string(self).unwrap_or_default()
    }

    fn options(&self, motor: MotorFile) -> Result<Options, servoid_identify::Error> {
        let cost = cost_by_name(&self.cost).ok_or_else(|| {
            servoid_identify::Error::Usage(format!("--cost {}: there is no such cost", self.cost))
        })?;
        if servoid_engine::solve::by_name(&self.algorithm).is_none() {
            return Err(servoid_identify::Error::Usage(format!(
                "--algorithm {}: there is no such method",
                self.algorithm
            )));
        }
        Ok(Options {
            effects: effects_by_name("--with", &self.effects)?,
            algorithm: self.algorithm.clone(),
            cost,
            budget: self.evaluations,
            seed: self.seed,
            force: self.force,
            error_ladder: true,
            known: motor.known,
            ..Options::default()
        })
    }

    /// The name of its result on a unit; what cannot be read has a name of its own.
    pub(crate) fn key(&self, unit: &Unit) -> String {
        let found = key(unit, &self.text(), VERSION);
        found.unwrap_or_else(|| format!("unread {}", unit.name))
    }

    /// Does it. `None` where it was stopped before its end.
    pub(crate) fn row(&self, unit: &Unit, key: String, progress: &dyn Progress) -> Option<Row> {
        let mut motor = None;
        let done = catch_unwind(AssertUnwindSafe(|| {
            let (recording, known) = read(unit)?;
            motor.clone_from(&known.name);
            match self.verb {
                Verb::Fit => self.fit(recording, known, progress),
                Verb::Diagnose => self.diagnose(recording, known, progress),
            }
        }));
        let done = done.unwrap_or_else(|_| {
            Err(Fault::of(
                "internal",
                "the work failed inside servoid; please report this with the recording",
            ))
        });
        let (found, fault) = match done {
            Ok(found) => (found, None),
            Err(fault) => (Found::default(), Some(fault)),
        };
        if found.interrupted {
            return None;
        }
        Some(Row {
            key,
            unit: unit.name.clone(),
            motor,
            labels: match &unit.content {
                Content::File(_) => None,
                Content::Columns(columns) => columns.labels(),
            },
            status: if fault.is_none() { OK } else { ERROR }.to_owned(),
            cause: fault.as_ref().map(|fault| fault.cause.to_owned()),
            message: fault.map(|fault| fault.message),
            verb: match self.verb {
                Verb::Fit => "fit",
                Verb::Diagnose => "diagnose",
            }
            .to_owned(),
            task: self.text(),
            version: VERSION.to_owned(),
            verdict: found.verdict,
            effects: found.effects,
            rms_counts: found.rms_counts,
            validate_rms_counts: found.validate_rms_counts,
            parameters: found.parameters,
            result: found.result,
        })
    }

    fn fit(
        &self,
        recording: Recording,
        motor: MotorFile,
        progress: &dyn Progress,
    ) -> Result<Found, Fault> {
        let options = self.options(motor)?;
        let sets = FitSets::of_several(vec![recording], Vec::new(), self.force)?;
        let fit = sets.identify(&options, progress)?;
        let json = schema::Fit::new(&fit, &sets.fitted, None);
        Ok(Found {
            verdict: None,
            effects: json.effects.clone(),
            rms_counts: finite(json.rms_counts),
            validate_rms_counts: None,
            parameters: parameters(&json.parameters),
            result: Some(text(&json)?),
            interrupted: fit.interrupted,
        })
    }

    fn diagnose(
        &self,
        recording: Recording,
        motor: MotorFile,
        progress: &dyn Progress,
    ) -> Result<Found, Fault> {
        let options = self.options(motor)?;
        let sets = Datasets::of_several(vec![recording], Vec::new(), &options)?;
        let budget = Budget::of(self.steps, progress.stop());
        let found = diagnose_datasets(&sets, &options, &budget, progress)?;
        let report = DiagnosisReport::new(&found, &sets.fitted, &sets.kind, self.seed, None);
        let json = schema::Diagnosis::from(&report);
        let last = &json.last;
        Ok(Found {
            verdict: Some(json.verdict.clone()),
            effects: last.effects.clone(),
            rms_counts: last.rms_counts.and_then(finite),
            validate_rms_counts: last.validate_rms_counts.and_then(finite),
            parameters: parameters(&last.parameters),
            result: Some(text(&json)?),
            interrupted: found.interrupted,
        })
    }
}

pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

fn read(unit: &Unit) -> Result<(Recording, MotorFile), Fault> {
    let motor = |error| Fault::of("motor", error);
    let recording = |error| Fault::of("recording", error);
    match &unit.content {
        Content::File(log) => {
            let known = MotorFile::find_beside(&log.path)
                .map_err(motor)?
                .unwrap_or_default();
            let unread = |why| Fault::of("recording", format!("{}: {why}", unit.name));
            // Under the unit's name: the result is the same wherever the folder lies.
            let read = read_recording_from(log.bytes().map_err(unread)?, &unit.name, &known);
            Ok((read.map_err(recording)?, known))
        }
        Content::Columns(columns) => {
            let known = columns.motor().map_err(motor)?;
            Ok((
                columns.recording(&unit.name, &known).map_err(recording)?,
                known,
            ))
        }
    }
}

fn text(json: &impl Serialize) -> Result<String, Fault> {
    serde_json::to_string(json).map_err(|error| Fault::of("internal", error))
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

fn parameters(of: &[Estimate]) -> Vec<Parameter> {
    let one = |estimate: &Estimate| Parameter {
        name: estimate.name.clone(),
        value: finite(estimate.value),
        std: estimate.std,
        unit: estimate.unit.clone(),
        identifiable: estimate.identifiable,
    };
    of.iter().map(one).collect()
}
