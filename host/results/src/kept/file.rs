//! One result, read from the file that a verb wrote with `--json`.

use super::told::{KeptContest, KeptDiagnosis, KeptFit, KeptSteady, KeptVerification};
use super::{ModelFault, json_place};
use crate::device_run::{Folder, Saved};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A result of some verb.
#[derive(Clone, Debug)]
pub enum Kept {
    /// Of `fit` or `demo`.
    Fit(Box<KeptFit>),
    /// Of `diagnose`.
    Diagnosis(Box<KeptDiagnosis>),
    /// Of `diagnose` of a curve of steady speeds.
    Steady(Box<KeptSteady>),
    /// Of `compare` or `paper`.
    Contest(Box<KeptContest>),
    /// Of `device verify`.
    Verification(Box<KeptVerification>),
    /// Of `device commission`, `record` or `run`, with the folder it lies in.
    Device(Box<Saved>, Folder),
}

/// A result that cannot be read: the file, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}{fault}", .path.display())]
pub struct KeptError {
    /// The file.
    pub path: PathBuf,
    /// What was seen in it and what to do.
    pub fault: KeptFault,
}

/// Why a result cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum KeptFault {
    /// The system refused.
    #[error(
        ": cannot be read: {0}; give the file that a verb wrote with --json FILE, or the folder of a device's run"
    )]
    Io(io::Error),
    /// It is no JSON, or a value has the wrong type.
    #[error(":{line}:{column}: {what}; give the file that a verb wrote with --json FILE")]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was seen.
        what: String,
    },
    /// It is something else.
    #[error(
        ": schema is `{0}`; a report is made of the JSON of fit, diagnose, compare, paper, demo or device verify, or of the \
         folder of a device's run"
    )]
    Schema(String),
    /// It was written by another version.
    #[error(
        ": {what}; it was written by another version of servoid, or by hand: write it again with --json"
    )]
    Keys {
        /// What was seen.
        what: String,
    },
    /// A model in it is none.
    #[error(": {0}; write the result again with --json")]
    Model(#[from] ModelFault),
    /// A device's folder that is not whole.
    #[error(": {0}")]
    Device(String),
}

impl Kept {
    /// Reads a result: a file, or the folder of a device's run.
    ///
    /// # Errors
    /// A file that cannot be read or is no result.
    pub fn read(path: &Path) -> Result<Self, KeptError> {
        let wrong = |fault| KeptError {
            path: path.to_path_buf(),
            fault,
        };
        if path.is_dir() {
            return device(path).map_err(wrong);
        }
        let text = fs::read_to_string(path).map_err(|error| wrong(KeptFault::Io(error)))?;
        let value: Value = serde_json::from_str(&text).map_err(|error| wrong(no_json(&error)))?;
        if schema(&value).as_deref() == Some("servoid.device/1") {
            return device(path.parent().unwrap_or(path)).map_err(wrong);
        }
        Self::from_json(value).map_err(wrong)
    }

    /// From the JSON of a result.
    ///
    /// # Errors
    /// What is no result.
    pub fn from_json(value: Value) -> Result<Self, KeptFault> {
        let schema = schema(&value);
        let kept = match schema.as_deref() {
            Some("servoid.fit/1") => Kept::Fit(keys(value)?),
            Some("servoid.diagnosis/1") if value.get("steady").is_some() => {
                Kept::Steady(keys(value)?)
            }
            Some("servoid.diagnosis/1") => Kept::Diagnosis(keys(value)?),
            Some("servoid.compare/1") => Kept::Contest(keys(value)?),
            Some("servoid.verify/1") => Kept::Verification(keys(value)?),
            other => return Err(KeptFault::Schema(other.unwrap_or("missing").to_owned())),
        };
        kept.check_models()?;
        Ok(kept)
    }

    /// Refuses models that are none, while it is known where they stand.
    fn check_models(&self) -> Result<(), KeptFault> {
        let diagnosis = match self {
            Kept::Fit(fit) => {
                fit.model.candidate("model")?;
                fit.diagnosis.as_ref()
            }
            Kept::Diagnosis(diagnosis) => Some(diagnosis),
            Kept::Verification(verification) => verification.diagnosis.as_ref(),
            Kept::Steady(_) | Kept::Contest(_) | Kept::Device(..) => None,
        };
        if let Some(diagnosis) = diagnosis {
            diagnosis.base.model.candidate("base.model")?;
            diagnosis.last.model.candidate("final.model")?;
        }
        Ok(())
    }
}

fn schema(value: &Value) -> Option<String> {
    value.get("schema")?.as_str().map(str::to_owned)
}

fn keys<T: DeserializeOwned>(value: Value) -> Result<T, KeptFault> {
    serde_json::from_value(value).map_err(|error| KeptFault::Keys {
        what: error.to_string(),
    })
}

fn no_json(error: &serde_json::Error) -> KeptFault {
    let (line, column, what) = json_place(error);
    KeptFault::Json { line, column, what }
}

fn device(path: &Path) -> Result<Kept, KeptFault> {
    let folder = Folder::at(path);
    let saved = folder
        .saved()
        .map_err(|error| KeptFault::Device(error.to_string()))?;
    Ok(Kept::Device(Box::new(saved), folder))
}
