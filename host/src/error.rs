//! Everything that can go wrong, and the exit code that says so.

use crate::bench::BenchError;
use crate::device::DeviceError;
use crate::diagnose::steady::SteadyError;
use crate::export::ExportError;
use crate::input::{MotorFileError, ReadError};
use crate::kept::{KeptError, ResultError};
use crate::output::WriteError;
use crate::prove::StoreError;
use shared::error::ModelError;
use thiserror::Error;

/// An error with its remedy in its message.
#[derive(Debug, Error)]
pub enum Error {
    /// A flag or argument that cannot be used.
    #[error("{0}")]
    Usage(String),
    /// A recording that cannot be read or used.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A motor file that cannot be read.
    #[error(transparent)]
    Motor(#[from] MotorFileError),
    /// The virtual bench refuses.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// No model can be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A file of finished cases cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A curve of steady speeds that cannot be read or used.
    #[error(transparent)]
    Steady(#[from] SteadyError),
    /// A result of another verb that cannot be read.
    #[error(transparent)]
    Kept(#[from] KeptError),
    /// A device, or the link to it.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A result that cannot be read again.
    #[error(transparent)]
    Result(#[from] ResultError),
    /// A format that cannot take what was found.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// The work was done as far as it goes, and it does not go far enough.
    #[error("{0}")]
    Failed(String),
}

impl Error {
    /// Exit code: 2 for wrong use, 1 for work that failed.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Usage(_) | Error::Device(DeviceError::Address(_) | DeviceError::Order(_)) => 2,
            _ => 1,
        }
    }
}
