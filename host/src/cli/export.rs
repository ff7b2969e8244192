//! `servoid export`.

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use servoid_results::export::gains::Loops;
use servoid_results::export::gains::design::Method;
use servoid_results::export::{FORMATS, Winding};
use std::path::PathBuf;

/// `servoid export`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct ExportArgs {
    /// What `fit`, `diagnose`, `demo` or `device verify` wrote with --json, or the folder of a device's run
    pub result: PathBuf,
    /// The format
    #[arg(long, value_name = "FORMAT", value_parser = formats())]
    pub to: String,
    /// Where it goes; stdout if not given
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Compute gains from the numbers of a device that did not verify them, too
    #[arg(long)]
    pub force: bool,
    /// Which shaft the numbers speak of
    #[arg(long, value_enum, default_value_t = SideName::Motor)]
    pub side: SideName,
    /// Turns of the motor a turn of the output, for --side output
    #[arg(long, value_name = "N")]
    pub ratio: Option<f64>,
    /// Period of the program that the export is for, s (c, rust, gains, ros2-control, odrive); the recording's if not given
    #[arg(long, value_name = "S")]
    pub sample: Option<f64>,
    /// Controllers.
    #[command(flatten)]
    pub gains: GainsArgs,
    /// Drives.
    #[command(flatten)]
    pub drive: DriveArgs,
}

/// What formats of brushless drives take.
#[derive(Debug, Args)]
#[command(next_help_heading = "Drives of brushless motors (--to odrive, vesc, moteus)")]
pub struct DriveArgs {
    /// What voltage and current of the recording were those of; line if not given
    #[arg(long, value_enum)]
    pub winding: Option<Winding>,
    /// Pairs of poles of the motor
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub pole_pairs: Option<u32>,
}

/// What formats with controllers take.
#[derive(Debug, Args)]
#[command(next_help_heading = "Controllers (--to gains, ros2-control, odrive)")]
pub struct GainsArgs {
    /// Where the current loop passes one, Hz (vesc and moteus too); a twentieth of the sampling rate if not given, 159 in a drive's own loop
    #[arg(long, value_name = "HZ")]
    pub current_bandwidth: Option<f64>,
    /// Where the speed loop passes one, Hz; as high as a good phase margin lets it if not given
    #[arg(long, value_name = "HZ")]
    pub speed_bandwidth: Option<f64>,
    /// How the speed loop's zero is placed; on a speed loop that gives volts cancel, else symmetrical
    #[arg(long, value_enum)]
    pub method: Option<Method>,
    /// Which loops (gains); a cascade where the resistance is known
    #[arg(long, value_enum)]
    pub loops: Option<Loops>,
}

/// Sides of a gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SideName {
    /// The shaft whose encoder was recorded
    Motor,
    /// The shaft behind a gear of --ratio
    Output,
}

const EXAMPLES: &str = "Example, first on a motor of the bench:
  servoid simulate --hide coulomb --excite commissioning-coast --out bench.csv
  servoid fit bench.csv --with coulomb --known resistance_ohm=2.3 --kt-equals-kb --json fit.json
  servoid export fit.json --to c --out motor.h
  servoid export fit.json --to mujoco --side output --ratio 30 --out motor.xml
  servoid export fit.json --to gains --speed-bandwidth 10
  servoid export fit.json --to vesc --pole-pairs 7";

fn formats() -> PossibleValuesParser {
    let formats = FORMATS.iter();
    PossibleValuesParser::new(formats.map(|f| PossibleValue::new(f.name).help(f.about)))
}
