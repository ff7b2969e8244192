//! `servoid fleet`, `servoid population` and `servoid draw`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The results of a batch, and what is known of its recordings beside them.
#[derive(Clone, Debug, Args)]
pub struct ResultsArgs {
    /// Folder of the results: the --out of `servoid batch`
    pub results: PathBuf,
    /// Of which motor, lot and station each recording is: a CSV file with a column unit, and serial, lot, station, operator, time
    #[arg(long, value_name = "FILE")]
    pub labels: Option<PathBuf>,
}

/// `servoid fleet`.
#[derive(Debug, Args)]
#[command(after_help = FLEET)]
pub struct FleetArgs {
    /// The results.
    #[command(flatten)]
    pub results: ResultsArgs,
    /// The fleet as one HTML page; with --unit that recording's page
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// The result of one recording, as `fit` or `diagnose` gave it
    #[arg(long, value_name = "NAME")]
    pub unit: Option<String>,
}

/// `servoid population`.
#[derive(Debug, Args)]
#[command(after_help = POPULATION)]
pub struct PopulationArgs {
    /// The results.
    #[command(flatten)]
    pub results: ResultsArgs,
}

/// `servoid draw`.
#[derive(Debug, Args)]
#[command(after_help = DRAW)]
pub struct DrawArgs {
    /// What `servoid population` wrote with --json
    pub population: PathBuf,
    /// How many motors
    #[arg(long, short, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    pub n: u32,
    /// The format
    #[arg(long, value_enum, default_value_t = DrawFormat::Npz)]
    pub to: DrawFormat,
    /// Where they go: a file, or with mujoco a folder with a model a motor
    #[arg(long, short, value_name = "PATH")]
    pub out: PathBuf,
}

/// What drawn motors are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DrawFormat {
    /// numpy: an array a parameter
    Npz,
    /// Parquet: a column a parameter
    Parquet,
    /// MuJoCo: a model a motor; needs torques in N*m
    Mujoco,
}

const FLEET: &str = "Examples:
  servoid fleet results
  servoid fleet results --labels units.csv --report fleet.html
  servoid fleet results --unit lot3/0042.csv --report 0042.html";

const POPULATION: &str = "Examples:
  servoid population results --json population.json";

const DRAW: &str = "Examples:
  servoid draw population.json -n 100000 --to npz --out motors.npz
  servoid draw population.json -n 64 --to mujoco --out motors --seed 7";
