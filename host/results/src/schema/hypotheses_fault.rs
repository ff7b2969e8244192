//! What can be wrong with a diagnosis that a plan is to be made from, each with its remedy.

use super::ModelFault;
use super::diagnosis::SCHEMA;
use std::io;
use std::path::PathBuf;

/// A diagnosis that no plan can be made from: the file, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}{fault}", .path.display())]
pub struct DiagnosisError {
    /// The file.
    pub path: PathBuf,
    /// What was seen in it and what to do.
    pub fault: DiagnosisFault,
}

/// Why no plan can be made from a diagnosis.
#[derive(Debug, thiserror::Error)]
pub enum DiagnosisFault {
    /// The system refused.
    #[error(": cannot be read: {0}; give the file that `servoid diagnose REC --json FILE` wrote")]
    Io(io::Error),
    /// It is no JSON, or a value has the wrong type. The message ends with line and column.
    #[error(
        ":{line}:{column}: {what}; give the file that `servoid diagnose REC --json FILE` wrote"
    )]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was seen.
        what: String,
    },
    /// It is some other result.
    #[error(
        ": schema is `{0}`, needed is `{SCHEMA}`; give the file that `servoid diagnose REC --json FILE` wrote"
    )]
    Schema(String),
    /// A diagnosis that carries no models.
    #[error(
        ": has no `{0}`: it was written by an older servoid; run `servoid diagnose REC --json FILE` again"
    )]
    Missing(&'static str),
    /// Something that is of no model.
    #[error(": {0}; run `servoid diagnose REC --json FILE` again")]
    Model(#[from] ModelFault),
    /// Nothing to separate.
    #[error(
        ": holds only one model ({0}): nothing else of the catalogue explains the recording as well, so that there is \
         nothing to separate; to plan against a rival that you have in mind, use --between with its name instead"
    )]
    OneModel(String),
}
