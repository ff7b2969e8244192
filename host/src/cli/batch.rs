//! `servoid batch`.

use super::{CostName, algorithm_names, effect_names};
use clap::{Args, ValueEnum};
use servoid_batch::Shard;
use servoid_identify::diagnose::USUAL_STEPS;
use std::path::PathBuf;

/// `servoid batch`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct BatchArgs {
    /// A folder with CSV recordings, each with a motor.toml beside it, or a Parquet file with one row a recording
    pub input: PathBuf,
    /// Folder of the results; what is there already is not done again
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// What is done to each recording
    #[arg(long = "do", value_enum, default_value_t = BatchVerb::Diagnose)]
    pub verb: BatchVerb,
    /// Effects of a fit beside the linear motor
    #[arg(long, value_delimiter = ',', value_name = "EFFECT,…", value_parser = effect_names())]
    pub with: Vec<String>,
    /// Search method of a fit
    #[arg(long, default_value = "lm", value_parser = algorithm_names())]
    pub algorithm: String,
    /// What a fit minimises
    #[arg(long, value_enum, default_value_t = CostName::Squared)]
    pub cost: CostName,
    /// Model evaluations of a fit at most
    #[arg(long, default_value_t = 20_000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub evaluations: u64,
    /// Steps of a model that a diagnosis takes at most, in millions
    #[arg(long, default_value_t = USUAL_STEPS / 1_000_000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub budget: u64,
    /// Use recordings that `servoid check` refuses
    #[arg(long)]
    pub force: bool,
    /// Do part i of n, as in 2/3: for several machines with one folder
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    pub shard: Shard,
    /// Do again what gave an error
    #[arg(long, value_enum, value_name = "WHAT")]
    pub retry: Option<Retry>,
    /// Recordings that are done at a time; one a core if not said
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub workers: Option<u16>,
    /// All results of the folder as one Parquet file, ordered by recording
    #[arg(long, value_name = "FILE")]
    pub table: Option<PathBuf>,
}

/// What is done to each recording.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum BatchVerb {
    /// A model is fitted
    Fit,
    /// The missing effects are named
    Diagnose,
}

/// What is done again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Retry {
    /// What gave an error
    Error,
}

const EXAMPLES: &str = "Examples:
  servoid batch logs --out results
  servoid batch logs --out results --do fit --with coulomb --table fits.parquet
  servoid batch lot.parquet --out results --shard 2/8";
