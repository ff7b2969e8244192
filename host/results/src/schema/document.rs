//! One result, read from the file that a verb wrote with `--json`.

use super::{
    Contest, Demo, DeviceRun, Diagnosis, Fit, ModelFault, Steady, Verification, contest, device,
    diagnosis, fit, json_place, verification,
};
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A result of some verb.
#[derive(Clone, Debug)]
pub enum Document {
    /// Of `fit`.
    Fit(Box<Fit>),
    /// Of `demo`.
    Demo(Box<Demo>),
    /// Of `diagnose`.
    Diagnosis(Box<Diagnosis>),
    /// Of `diagnose` of a curve of steady speeds.
    Steady(Box<Steady>),
    /// Of `compare` or `paper`.
    Contest(Box<Contest>),
    /// Of `device verify`.
    Verification(Box<Verification>),
    /// Of `device commission`, `record` or `run`, with the folder it lies in.
    Device(Box<DeviceRun>, PathBuf),
}

/// A result that cannot be read: the file, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}{fault}", .path.display())]
pub struct DocumentError {
    /// The file.
    pub path: PathBuf,
    /// What was seen in it and what to do.
    pub fault: DocumentFault,
}

/// Why a result cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum DocumentFault {
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

impl Document {
    /// Reads a result: a file, or the folder of a device's run.
    ///
    /// # Errors
    /// A file that cannot be read or is no result.
    pub fn read(path: &Path) -> Result<Self, DocumentError> {
        let wrong = |fault| DocumentError {
            path: path.to_path_buf(),
            fault,
        };
        if path.is_dir() {
            return device(path).map_err(wrong);
        }
        let text = fs::read_to_string(path).map_err(|error| wrong(DocumentFault::Io(error)))?;
        let value: Value = serde_json::from_str(&text).map_err(|error| wrong(no_json(&error)))?;
        if schema(&value).as_deref() == Some(device::SCHEMA) {
            return device(path.parent().unwrap_or(path)).map_err(wrong);
        }
        Self::from_json(value).map_err(wrong)
    }

    /// From the JSON of a result.
    ///
    /// # Errors
    /// What is no result.
    pub fn from_json(value: Value) -> Result<Self, DocumentFault> {
        let schema = schema(&value);
        let document = match schema.as_deref() {
            Some(fit::SCHEMA) if is_demo(&value) => Document::Demo(keys(value)?),
            Some(fit::SCHEMA) => Document::Fit(keys(value)?),
            Some(diagnosis::SCHEMA) if value.get("steady").is_some() => {
                Document::Steady(keys(value)?)
            }
            Some(diagnosis::SCHEMA) => Document::Diagnosis(keys(value)?),
            Some(contest::SCHEMA) => Document::Contest(keys(value)?),
            Some(verification::SCHEMA) => Document::Verification(keys(value)?),
            other => return Err(DocumentFault::Schema(other.unwrap_or("missing").to_owned())),
        };
        document.check_models()?;
        Ok(document)
    }

    /// Refuses models that are none, while it is known where they stand.
    fn check_models(&self) -> Result<(), DocumentFault> {
        let diagnosis = match self {
            Document::Fit(fit) => {
                fit.model.candidate("model")?;
                None
            }
            Document::Demo(demo) => {
                demo.fit.model.candidate("model")?;
                demo.diagnosis.as_ref()
            }
            Document::Diagnosis(diagnosis) => Some(diagnosis),
            Document::Verification(verification) => verification.diagnosis.as_ref(),
            Document::Steady(_) | Document::Contest(_) | Document::Device(..) => None,
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

/// A demonstration is a fit with its truth and its diagnosis beside it.
fn is_demo(value: &Value) -> bool {
    ["hidden", "diagnosis"]
        .iter()
        .any(|&key| value.get(key).is_some())
}

fn keys<T: DeserializeOwned>(value: Value) -> Result<T, DocumentFault> {
    serde_path_to_error::deserialize(value).map_err(|error| DocumentFault::Keys {
        what: error.to_string(),
    })
}

fn no_json(error: &serde_json::Error) -> DocumentFault {
    let (line, column, what) = json_place(error);
    DocumentFault::Json { line, column, what }
}

fn device(folder: &Path) -> Result<Document, DocumentFault> {
    let run = DeviceRun::read(folder).map_err(|error| DocumentFault::Device(error.to_string()))?;
    Ok(Document::Device(Box::new(run), folder.to_path_buf()))
}
