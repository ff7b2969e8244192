//! Why a result cannot be shown, with the remedy.

use shared::error::ModelError;
use thiserror::Error;

/// A result that cannot be shown.
#[derive(Debug, Error)]
pub enum Error {
    /// The work was done as far as it goes, and it does not go far enough.
    #[error("{0}")]
    Failed(String),
    /// No model can be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The identification behind it gives nothing.
    #[error(transparent)]
    Identify(#[from] servoid_identify::Error),
}
