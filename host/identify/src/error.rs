//! Why an identification gives no result, with the remedy.

use servoid_engine::data::JoinError;
use servoid_io::input::ReadError;
use servoid_plant::BenchError;
use shared::error::ModelError;
use thiserror::Error;

/// An identification that gives no result.
#[derive(Debug, Error)]
pub enum Error {
    /// An option that cannot be used: the caller's mistake.
    #[error("{0}")]
    Usage(String),
    /// The work was done as far as it goes, and it does not go far enough.
    #[error("{0}")]
    Failed(String),
    /// No model can be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// Recordings that cannot be taken together.
    #[error(transparent)]
    Join(#[from] JoinError),
    /// A recording that cannot be used.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The virtual bench refuses.
    #[error(transparent)]
    Bench(#[from] BenchError),
}

impl Error {
    /// The word by which programs tell errors apart.
    pub fn cause(&self) -> &'static str {
        match self {
            Error::Usage(_) => "usage",
            Error::Failed(_) => "failed",
            Error::Model(_) => "model",
            Error::Join(_) => "join",
            Error::Read(_) => "recording",
            Error::Bench(_) => "bench",
        }
    }
}
