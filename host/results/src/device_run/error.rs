//! Why the folder of a run cannot be used, with the remedy.

use crate::schema::device::ReportError;
use servoid_io::input::{MotorFileError, ReadError};
use servoid_io::output::WriteError;
use std::path::PathBuf;

/// A folder of a run that cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// A folder or a report that cannot be used.
    #[error("{}: {why}", .path.display())]
    Unusable {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it, and what to do.
        why: String,
    },
    /// A recording that cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A motor file that cannot be read.
    #[error(transparent)]
    Motor(#[from] MotorFileError),
    /// A file that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl From<ReportError> for FolderError {
    fn from(ReportError { path, why }: ReportError) -> Self {
        FolderError::Unusable { path, why }
    }
}
