//! Why nothing can be said of a fleet.

use servoid_io::output::WriteError;
use std::path::PathBuf;
use thiserror::Error;

/// An error with its remedy in its message.
#[derive(Debug, Error)]
pub enum Error {
    /// Something that the caller must change.
    #[error("{0}")]
    Usage(String),
    /// A folder of results that cannot be read.
    #[error(transparent)]
    Batch(#[from] servoid_batch::Error),
    /// A file that cannot be read as what it should be.
    #[error("{}: {why}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// What was found is not enough for what was asked.
    #[error("{0}")]
    TooLittle(String),
    /// A model that an export cannot carry.
    #[error("{0}")]
    Export(String),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// What is wrong with the content of this file.
pub(crate) fn content<E: std::fmt::Display>(path: impl Into<PathBuf>) -> impl FnOnce(E) -> Error {
    let path = path.into();
    move |why| Error::Content {
        path,
        why: why.to_string(),
    }
}
