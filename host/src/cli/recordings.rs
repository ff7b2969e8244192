//! The recordings of a fit or a diagnosis.

use clap::Args;
use std::path::{Path, PathBuf};

/// The recordings of a fit or a diagnosis.
#[derive(Debug, Args)]
pub struct RecordingsArgs {
    /// Recordings of one motor, fitted together; `diagnose` also takes one CSV of steady speeds: voltage_V and speed_rad_s alone
    #[arg(value_name = "RECORDING", required_unless_present = "validate")]
    fitted: Vec<PathBuf>,
    /// Other recordings of the same motor, never fitted. Without any, `diagnose` holds out the last of several recordings, or
    /// the last quarter of the only one
    #[arg(long, value_name = "FILE", num_args = 1..)]
    validate: Vec<PathBuf>,
}

impl RecordingsArgs {
    /// Those that are fitted.
    pub fn fitted(&self) -> &[PathBuf] {
        split(&self.fitted, &self.validate).0
    }

    /// Those that are not.
    pub fn held_out(&self) -> &[PathBuf] {
        split(&self.fitted, &self.validate).1
    }

    /// The first that is fitted.
    pub fn first(&self) -> Option<&Path> {
        self.fitted().first().map(PathBuf::as_path)
    }
}

/// Those that are fitted, and those that are not. Where none stands before `--validate`, it is the last one behind it:
/// `fit --validate b.csv a.csv` fits a.csv.
pub(super) fn split<'a>(
    fitted: &'a [PathBuf],
    validate: &'a [PathBuf],
) -> (&'a [PathBuf], &'a [PathBuf]) {
    match validate {
        [others @ .., last] if fitted.is_empty() && !others.is_empty() => {
            (std::slice::from_ref(last), others)
        }
        _ => (fitted, validate),
    }
}
