//! Why a batch cannot go on. What is wrong with one recording is a row of the table, and no error.

use servoid_io::output::WriteError;
use std::path::PathBuf;
use thiserror::Error;

/// An error with its remedy in its message.
#[derive(Debug, Error)]
pub enum Error {
    /// Something that the caller must change.
    #[error("{0}")]
    Usage(String),
    /// A file or folder that the system refuses.
    #[error("{}: {why}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        why: std::io::Error,
    },
    /// A file of recordings or results that cannot be read as what it should be.
    #[error("{}: {why}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// Another run has the folder.
    #[error(
        "{}: another servoid batch works on this part of the folder; wait for it, stop it, or take another --shard",
        path.display()
    )]
    Busy {
        /// The folder's lock.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// An error of the system at this file.
pub(crate) fn io(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Error {
    let path = path.into();
    move |why| Error::Io { path, why }
}

/// What is wrong with the content of this file.
pub(crate) fn content<E: std::fmt::Display>(path: impl Into<PathBuf>) -> impl FnOnce(E) -> Error {
    let path = path.into();
    move |why| Error::Content {
        path,
        why: why.to_string(),
    }
}
