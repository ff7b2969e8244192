//! What can be wrong with a result that is read again, each with its remedy.

use super::ModelFault;
use std::io;
use std::path::PathBuf;

/// A result that cannot be used: the file, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}{fault}", .path.display())]
pub struct ResultError {
    /// The file.
    pub path: PathBuf,
    /// What was seen in it and what to do.
    pub fault: ResultFault,
}

/// Why a result cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum ResultFault {
    /// The system refused.
    #[error(
        ": cannot be read: {0}; give the file that `servoid fit REC --json FILE` or `servoid diagnose REC --json FILE` wrote"
    )]
    Io(io::Error),
    /// It is no JSON, or a value has the wrong type.
    #[error(
        ":{line}:{column}: {what}; give the file that `servoid fit REC --json FILE` or `servoid diagnose REC --json FILE` wrote"
    )]
    Json {
        /// Line, from 1; 0 where the place is not known.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was seen.
        what: String,
    },
    /// It is some other result.
    #[error(
        ": schema is `{0}`, needed is servoid.fit/1, servoid.diagnosis/1, servoid.verify/1 or servoid.device/1; give the \
         file that `servoid fit REC --json FILE` or `servoid diagnose REC --json FILE` wrote"
    )]
    Schema(String),
    /// A key that is not there.
    #[error(
        ": has no `{0}`: it was written by an older servoid or cut off; run the verb that wrote it again"
    )]
    Missing(&'static str),
    /// A drive that nobody knows.
    #[error(": drive is `{0}`, needed is `voltage`, `current` or `torque`")]
    Drive(String),
    /// A parameter whose name is none.
    #[error(
        ": a parameter is called `{0}`, which no servoid writes; run the verb that wrote it again"
    )]
    Name(String),
    /// A curve of steady speeds.
    #[error(
        ": is the diagnosis of a curve of steady speeds, which says nothing of inertia and time constants; record an \
         encoder in motion and fit that"
    )]
    Steady,
    /// A verification that diagnosed nothing.
    #[error(
        ": holds no diagnosis; export the device's own fit (the folder), or fit one of its recordings: `servoid fit \
         FOLDER/recording.csv --json FILE`"
    )]
    Undiagnosed,
    /// A device that did not fit.
    #[error(
        ": the device did not fit (`outcome` is null); commission the motor, or fit its recording: `servoid fit \
         FOLDER/recording.csv --json FILE`"
    )]
    NotFitted,
    /// Something that is of no model.
    #[error(": {0}; run the verb that wrote it again")]
    Model(#[from] ModelFault),
}
