//! Everything that can go wrong with the program, and the exit code that says so.

use crate::device::DeviceError;
use crate::prove::StoreError;
use servoid_identify::steady::SteadyError;
use servoid_io::columns::ColumnsError;
use servoid_io::input::{CurveError, MotorFileError, ReadError};
use servoid_io::output::WriteError;
use servoid_plant::BenchError;
use servoid_results::device_run::FolderError;
use servoid_results::export::ExportError;
use servoid_results::schema::{DocumentError, ResultError};
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
    /// A file of commands that cannot be read.
    #[error(transparent)]
    Columns(#[from] ColumnsError),
    /// The virtual bench refuses.
    #[error(transparent)]
    Bench(#[from] BenchError),
    /// No model can be built.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// A batch that cannot go on.
    #[error(transparent)]
    Batch(#[from] servoid_batch::Error),
    /// A fleet of which nothing can be said.
    #[error(transparent)]
    Fleet(#[from] servoid_fleet::Error),
    /// A file of finished cases cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// A curve of steady speeds that cannot be read.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// A curve of steady speeds that cannot be used.
    #[error(transparent)]
    Steady(#[from] SteadyError),
    /// A result of another verb that cannot be read.
    #[error(transparent)]
    Document(#[from] DocumentError),
    /// A device, or the link to it.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The folder of a device's run.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// A result that cannot be read again.
    #[error(transparent)]
    Result(#[from] ResultError),
    /// A format that cannot take what was found.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// An identification that gives no result.
    #[error(transparent)]
    Identify(#[from] servoid_identify::Error),
    /// A result that cannot be shown.
    #[error(transparent)]
    Show(#[from] servoid_results::Error),
    /// The work was done as far as it goes, and it does not go far enough.
    #[error("{0}")]
    Failed(String),
}

impl Error {
    /// Whether a log cannot be read only because it was not said what its columns are, or a fact that they need.
    pub fn asks_what_a_log_is(&self) -> bool {
        matches!(self, Error::Read(error) if error.fault.asks_what_a_log_is())
    }

    /// Exit code: 2 for wrong use, 1 for work that failed.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Usage(_)
            | Error::Batch(servoid_batch::Error::Usage(_))
            | Error::Fleet(servoid_fleet::Error::Usage(_))
            | Error::Device(DeviceError::Address(_) | DeviceError::Order(_))
            | Error::Identify(servoid_identify::Error::Usage(_)) => 2,
            _ => 1,
        }
    }
}
