//! `servoid bench`.

use super::MotorArgs;
use super::recordings::split;
use clap::Args;
use std::path::PathBuf;

/// `servoid bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// Recordings of one motor, fitted together, or a session that the workbench saved; an empty bench if not given
    #[arg(value_name = "RECORDING")]
    fitted: Vec<PathBuf>,
    /// Other recordings of the same motor, never fitted. Without any, the last of several recordings is held out, or the last
    /// quarter of the only one
    #[arg(long, value_name = "FILE", num_args = 1..)]
    validate: Vec<PathBuf>,
    /// Keep the bench in this file, and go on with what is in it; beside a recording, a new file
    #[arg(long, value_name = "FILE")]
    pub session: Option<PathBuf>,
    /// Do not open a browser
    #[arg(long)]
    pub no_open: bool,
    /// Port on 127.0.0.1; a free one if zero
    #[arg(long, default_value_t = 0, value_name = "PORT")]
    pub port: u16,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

impl BenchArgs {
    /// The recordings that are fitted, or a session.
    pub fn fitted(&self) -> &[PathBuf] {
        split(&self.fitted, &self.validate).0
    }

    /// The recordings that are not.
    pub fn held_out(&self) -> &[PathBuf] {
        split(&self.fitted, &self.validate).1
    }
}
