//! `servoid prove`.

use super::{CostName, effect_names};
use crate::prove::{Excite, HowMany, Laws, Shard};
use clap::Args;
use std::path::PathBuf;

/// `servoid prove`.
#[derive(Debug, Args)]
pub struct ProveArgs {
    /// Number of cases
    #[arg(long, default_value_t = 100, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub cases: u64,
    /// In place of diagnoses: how often the standard errors of fits hold the truth, over --cases recordings of each of several
    /// drives and encoders, or with each --effect
    #[arg(long, conflicts_with_all = ["hidden", "excite", "law", "discover", "only", "out", "resume"])]
    pub coverage: bool,
    /// What the fits of --coverage minimise: squares, or the likelihood of the cells that were read (interval), with noise before
    /// the counter
    #[arg(long, value_enum, default_value_t = CostName::Squared, requires = "coverage")]
    pub cost: CostName,
    /// How many effects a case hides
    #[arg(long, visible_alias = "hide", value_enum, default_value_t = HowMany::Mix)]
    pub hidden: HowMany,
    /// How the motor is driven
    #[arg(long, value_enum, default_value_t = Excite::Commissioning)]
    pub excite: Excite,
    /// Effects to choose from, all if not given; with --hidden formula one of them is beside the law, none if not given
    #[arg(long, value_delimiter = ',', num_args = 1.., value_name = "EFFECT", value_parser = effect_names())]
    pub effect: Vec<String>,
    /// By which curves the hidden effects act: the model's own, or others that the field has for them
    #[arg(long, value_enum, default_value_t = Laws::Own)]
    pub law: Laws,
    /// Propose laws for what the catalogue leaves, as `servoid diagnose --discover` does
    #[arg(long)]
    pub discover: bool,
    /// Do every n-th case only, beginning with the i-th
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Do the cases of these numbers only
    #[arg(long, value_delimiter = ',', value_name = "CASE,…", conflicts_with_all = ["shard", "cases"])]
    pub only: Vec<u64>,
    /// Where each finished case goes, a line of JSON
    #[arg(long, short, value_name = "FILE", conflicts_with = "resume")]
    pub out: Option<PathBuf>,
    /// Continue this file of --out: what is in it is not done again
    #[arg(long, value_name = "FILE")]
    pub resume: Option<PathBuf>,
    /// Plot of what was stated against how often it was right (SVG)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Do nothing new: the joint table of these files of --out, or with --coverage of --json
    #[arg(long, num_args = 1.., value_name = "FILE", conflicts_with_all = ["cases", "hidden", "excite", "effect", "law", "discover", "shard", "only", "out", "resume"])]
    pub merge: Vec<PathBuf>,
}
