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
    /// Those that are fitted. Where none stands before `--validate`, it is the last one behind it:
    /// `fit --validate b.csv a.csv` fits a.csv.
    pub fn fitted(&self) -> &[PathBuf] {
        match self.split() {
            Some((_, last)) => std::slice::from_ref(last),
            None => &self.fitted,
        }
    }

    /// Those that are not.
    pub fn held_out(&self) -> &[PathBuf] {
        self.split()
            .map_or(&self.validate, |(held_out, _)| held_out)
    }

    /// The first that is fitted.
    pub fn first(&self) -> Option<&Path> {
        self.fitted().first().map(PathBuf::as_path)
    }

    fn split(&self) -> Option<(&[PathBuf], &PathBuf)> {
        let (last, others) = self.validate.split_last()?;
        (self.fitted.is_empty() && !others.is_empty()).then_some((others, last))
    }
}
