//! `servoid bench`.

use super::MotorArgs;
use clap::Args;
use std::path::PathBuf;

/// `servoid bench`.
#[derive(Debug, Args)]
pub struct BenchArgs {
    /// A recording, or a session that the workbench saved; an empty bench if not given
    pub recording: Option<PathBuf>,
    /// Another recording of the same motor, never fitted; else the last quarter of the first is held out
    #[arg(long, value_name = "FILE")]
    pub validate: Option<PathBuf>,
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
