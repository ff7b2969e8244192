//! `servoid report`, and the flag of the verbs that write the same page.

use super::MotorArgs;
use clap::Args;
use std::path::PathBuf;

/// `servoid report`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ReportArgs {
    /// What fit, diagnose, compare, paper, demo or device verify wrote with --json, or the folder of a device's run
    pub result: PathBuf,
    /// Where the page goes
    #[arg(
        long,
        short,
        default_value = "servoid-report.html",
        value_name = "FILE"
    )]
    pub out: PathBuf,
    /// The fitted recording, if it is no longer where it was
    #[arg(long, value_name = "FILE")]
    pub recording: Option<PathBuf>,
    /// The recording that was never fitted, if it is no longer where it was
    #[arg(long, value_name = "FILE")]
    pub validate: Option<PathBuf>,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

/// The page of a verb's own result.
#[derive(Clone, Debug, Default, Args)]
pub struct PageArgs {
    /// Page with the verdict, the drawings and the tables (HTML)
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
}

const EXAMPLES: &str = "Example:
  servoid simulate --hide cogging --out bench.csv
  servoid diagnose bench.csv --json diagnosis.json
  servoid report diagnosis.json --out diagnosis.html";
