//! The shape of the command line, and nothing else.

mod batch;
mod bench;
mod device;
mod export;
mod fleet;
mod prove;
mod recordings;
#[cfg(test)]
mod reference;
mod report;
mod simulate;

pub use batch::{BatchArgs, BatchVerb, Retry};
pub use bench::BenchArgs;
pub use device::{
    CommissionArgs, DeviceArgs, DeviceBenchArgs, DeviceMethod, DeviceVerb, EmulateArgs,
    EmulationArgs, FollowArgs, LimitArgs, OnDevice, PortArgs, RecordArgs, RunArgs, StreamArgs,
    Switch, VerifyArgs,
};
pub use export::{ExportArgs, GainsArgs, SideName};
pub use fleet::{DrawArgs, DrawFormat, FleetArgs, PopulationArgs, ResultsArgs};
pub use prove::ProveArgs;
pub use recordings::RecordingsArgs;
pub use report::{PageArgs, ReportArgs};
pub use simulate::{PlanArgs, SimulateArgs};

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, Args, Parser, Subcommand, ValueEnum};
use servoid_engine::solve;
use servoid_identify::diagnose::USUAL_STEPS;
use servoid_io::input::PRESETS;
use shared::effects::Kind;
use std::path::PathBuf;

/// Identifies DC servo motors from encoder recordings: fits, compares methods, and reproduces the
/// paper it grew from.
#[derive(Debug, Parser)]
#[command(name = "servoid", version, propagate_version = true, after_help = EXAMPLES)]
#[command(mut_args(with_negative_values))]
#[command(mut_subcommands(|verb| verb.mut_args(with_negative_values).display_name("servoid")))]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
    /// What every verb takes.
    #[command(flatten)]
    pub common: Common,
}

const EXAMPLES: &str = "Examples:
  servoid demo
  servoid demo --hide cogging
  servoid simulate --machine gearmotor --hide coulomb --out bench.csv
  servoid simulate --plan --between coulomb,brush_drop --out plan.csv
  servoid open bench.csv
  servoid fit bench.csv --with coulomb --json fit.json
  servoid export fit.json --to wpilib
  servoid diagnose bench.csv
  servoid compare bench.csv --seeds 5 --budget 500

Results go to stdout, progress to stderr. Exit code 0: done; 1: the work failed; 2: wrong use.";

/// Options of every verb.
#[derive(Clone, Debug, Args)]
pub struct Common {
    /// Write the result as JSON to this file; `-` for stdout (then nothing else goes there)
    #[arg(long, global = true, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Seed of everything random
    #[arg(long, global = true, default_value_t = 1, value_name = "N")]
    pub seed: u64,
    /// No progress bar, no remarks
    #[arg(long, short, global = true)]
    pub quiet: bool,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// The main job on built-in data: fit, see it fail, name what is missing, add it
    Demo(DemoArgs),
    /// The virtual bench makes recordings
    Simulate(SimulateArgs),
    /// What a log of any usual format holds, and how to fit it
    Open(OpenArgs),
    /// What recordings can be trusted for, before anything is fitted to them
    Check(CheckArgs),
    /// Fits the model to a recording
    Fit(FitArgs),
    /// Finds where the linear motor fails, names the missing effects and adds them one by one
    Diagnose(DiagnoseArgs),
    /// Writes what was found for other programs: constants, simulators, controllers
    Export(ExportArgs),
    /// Fits or diagnoses many recordings, one row of a table each; resumes, and splits over machines
    Batch(BatchArgs),
    /// What a batch says of all motors together: distributions, odd ones, lots, stations, drift
    Fleet(FleetArgs),
    /// The population that the motors of a batch are a sample of: means, spreads, correlations
    Population(PopulationArgs),
    /// Draws motors from a population, for simulation
    Draw(DrawArgs),
    /// Compares search methods at an equal budget over many seeds
    Compare(CompareArgs),
    /// Reproduces the paper: its motor, its step, its bounds, its table beside ours
    Paper(PaperArgs),
    /// The workbench: a page on this machine to fit, compare, name what is missing and add it
    Bench(BenchArgs),
    /// The pictures, the tables and the verdict of a result as one HTML file
    Report(ReportArgs),
    /// Diagnoses random motors with random hidden effects, and says how good that was
    Prove(ProveArgs),
    /// Talks to the firmware: commissions a motor on its own controller, and checks what it found
    Device(DeviceArgs),
    /// The effects that can be told: equation, sign, experiment, remedy, look-alikes
    Effects(EffectsArgs),
    /// Prints a completion script for a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// `servoid demo`.
#[derive(Debug, Args)]
pub struct DemoArgs {
    /// Where the page goes
    #[arg(long, default_value = "servoid-demo.html", value_name = "FILE")]
    pub out: PathBuf,
    /// Hide this in the motor: a name, or name:key=value,key=value as in `simulate`
    #[arg(long, default_value = "coulomb", value_name = "EFFECT")]
    pub hide: String,
    /// Hide something that the seed draws, and reveal it at the end
    #[arg(long, conflicts_with = "hide")]
    pub blind: bool,
}

/// What a user knows of the motor and the log: a file, or flags for each.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "The motor and the log")]
pub struct MotorArgs {
    /// What is known of the motor and its log; else motor.toml beside the recording
    #[arg(long, value_name = "FILE")]
    pub motor: Option<PathBuf>,
    /// Encoder counts per revolution
    #[arg(long, value_name = "N")]
    pub counts_per_rev: Option<f64>,
    /// Supply voltage, V
    #[arg(long = "supply-v", value_name = "V")]
    pub supply: Option<f64>,
    /// Travel per revolution, m, for an angle logged in metres
    #[arg(long, value_name = "M")]
    pub metres_per_rev: Option<f64>,
    /// The program that wrote the log: columns, units and drive are as it writes them
    #[arg(long, value_name = "NAME", value_parser = preset_names())]
    pub preset: Option<String>,
    /// Name of a column: time, voltage (target with --drive position), angle, current, temperature, enabled or direction (0 or negative:
    /// backwards), as in angle=qm; of a table without names its number, of columns of several tables TABLE:COLUMN
    #[arg(long, value_name = "WHAT=NAME")]
    pub column: Vec<String>,
    /// Unit of a column, as in angle=rad, voltage=percent or angle=rpm for a speed; with a minus where the sign is the other one
    #[arg(long, value_name = "WHAT=UNIT")]
    pub unit: Vec<String>,
    /// The table of the log: a topic, a variable, an episode
    #[arg(long, value_name = "NAME")]
    pub table: Option<String>,
    /// The rows with a value in a column, as in joint=2; may be repeated
    #[arg(long, value_name = "COLUMN=VALUE")]
    pub select: Vec<String>,
    /// Samples a second, of a log without times
    #[arg(long, value_name = "HZ")]
    pub rate: Option<f64>,
    /// Begin so long after the first sample, s
    #[arg(long, value_name = "S")]
    pub from: Option<f64>,
    /// End so long after the first sample, s
    #[arg(long, value_name = "S")]
    pub to: Option<f64>,
    /// Keep all this in motor.toml beside the recording, unless there is one
    #[arg(long)]
    pub write_motor: bool,
    /// What the command sets; position: a target angle, behind which the drive closes a loop
    #[arg(long, value_name = "voltage|current|position")]
    pub drive: Option<String>,
    /// Of the position loop: gain_v_per_rad, damping_v_s_per_rad, limit_v, dead_band_rad or rate_hz, as in gain_v_per_rad=8.4
    #[arg(long = "loop", value_name = "WHAT=VALUE")]
    pub position_loop: Vec<String>,
    /// A known fact, as in resistance_ohm=1.2 or resistance_ohm=1.2~0.05 (5 % tolerance)
    #[arg(long, value_name = "FACT=VALUE")]
    pub known: Vec<String>,
    /// Torque and back-EMF constant are the same number (SI, no iron losses)
    #[arg(long)]
    pub kt_equals_kb: bool,
}

fn preset_names() -> PossibleValuesParser {
    let presets = PRESETS.iter();
    PossibleValuesParser::new(presets.map(|p| PossibleValue::new(p.name).help(p.about)))
}

/// `servoid effects`.
#[derive(Clone, Debug, Args)]
pub struct EffectsArgs {
    /// One of them; a list of all if not given
    #[arg(value_parser = effect_names(), conflicts_with_all = ["effect", "effects"])]
    pub name: Option<String>,
    /// Laws of the user's own in the place of the catalogue.
    #[command(flatten)]
    pub formulas: FormulaArgs,
    /// Write these laws as statics of Rust, for firmware that states them when it is built
    #[arg(long, value_name = "FILE")]
    pub emit_rust: Option<PathBuf>,
}

/// Laws that the user states.
#[derive(Clone, Debug, Args)]
pub struct FormulaArgs {
    /// A law of your own as an effect, as in "drag: torque = -c*w*abs(w); c in [0, 1e-3] V*s^2/rad^2"; may be repeated
    #[arg(long, value_name = "LAW")]
    pub effect: Vec<String>,
    /// Laws by their names in the table `effects` of a TOML file; may be repeated
    #[arg(long, value_name = "FILE")]
    pub effects: Vec<PathBuf>,
}

/// What the model is made of and what is minimised.
#[derive(Clone, Debug, Args)]
pub struct ModelArgs {
    /// Effects beside the linear machine
    #[arg(long, value_delimiter = ',', value_name = "EFFECT,…", value_parser = effect_names())]
    pub with: Vec<String>,
    /// Laws of the user's own beside the linear machine.
    #[command(flatten)]
    pub formulas: FormulaArgs,
    /// What is minimised
    #[arg(long, value_enum, default_value_t = CostName::Squared)]
    pub cost: CostName,
    /// Let the model run on its own for this long only, then set it back to the measurement, s
    #[arg(long, value_name = "S")]
    pub window: Option<f64>,
    /// Discretisation of the model
    #[arg(long, value_enum, default_value_t = Integrator::Exact)]
    pub integrator: Integrator,
    /// Steps to a sample interval where there are effects
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub substeps: u16,
    /// Search range of an unknown, as in gain=10:100; may be repeated
    #[arg(long, value_name = "NAME=LOW:HIGH", allow_hyphen_values = true)]
    pub bounds: Vec<String>,
}

/// `servoid open`.
#[derive(Debug, Args)]
pub struct OpenArgs {
    /// The log: a file of any format that is read, or a folder of LeRobot
    pub log: PathBuf,
    /// Plot of the columns against time or rows (SVG)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

/// `servoid check`.
#[derive(Debug, Args)]
pub struct CheckArgs {
    /// The recordings
    #[arg(required = true)]
    pub recordings: Vec<PathBuf>,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

/// `servoid fit`.
#[derive(Debug, Args)]
pub struct FitArgs {
    /// The recordings.
    #[command(flatten)]
    pub recordings: RecordingsArgs,
    /// Search method
    #[arg(long, default_value = "lm", value_parser = algorithm_names())]
    pub algorithm: String,
    /// Model evaluations at most
    #[arg(long, default_value_t = 20_000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub budget: u64,
    /// Parameters that each of several recordings has for itself, as in offset_voltage.voltage
    #[arg(long, value_delimiter = ',', value_name = "PARAMETER,…")]
    pub own: Vec<String>,
    /// Say whether one model reproduces every reading, and how far each parameter may then go
    #[arg(long)]
    pub certificate: bool,
    /// Hold each parameter at other values, fit the rest, and say how much worse that is: intervals that need be no parabola
    #[arg(long)]
    pub profile: bool,
    /// Fit a recording that `servoid check` refuses
    #[arg(long)]
    pub force: bool,
    /// Plot of measured against model (SVG)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// The model.
    #[command(flatten)]
    pub model: ModelArgs,
    /// The page.
    #[command(flatten)]
    pub page: PageArgs,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

/// `servoid diagnose`.
#[derive(Debug, Args)]
#[command(after_help = DIAGNOSE_EXAMPLES)]
pub struct DiagnoseArgs {
    /// The recordings.
    #[command(flatten)]
    pub recordings: RecordingsArgs,
    /// Steps of a model at most, in millions; what is best by then is reported. The usual number takes between one
    /// and two minutes of one processor core, and few recordings need a tenth of it
    #[arg(long, default_value_t = USUAL_STEPS / 1_000_000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub budget: u64,
    /// Laws that are tried beside the effects of the catalogue.
    #[command(flatten)]
    pub formulas: FormulaArgs,
    /// Look for a law of its own where the catalogue leaves something, and try it as an effect
    #[arg(long)]
    pub discover: bool,
    /// Diagnose recordings that `servoid check` refuses
    #[arg(long)]
    pub force: bool,
    /// The page.
    #[command(flatten)]
    pub page: PageArgs,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

const DIAGNOSE_EXAMPLES: &str = "Example, first on a motor of the bench:
  servoid simulate --hide load_torque --excite steps --out first.csv
  servoid simulate --hide load_torque --excite steps --seed 2 --out second.csv
  servoid diagnose first.csv --validate second.csv --json diagnosis.json
  servoid simulate --plan --after diagnosis.json --out next.csv";

/// `servoid compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// The recording
    pub recording: PathBuf,
    /// Search methods; all if not given
    #[arg(long, value_delimiter = ',', value_parser = algorithm_names())]
    pub algorithm: Vec<String>,
    /// Model evaluations of each run
    #[arg(long, default_value_t = 5000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub budget: u64,
    /// Runs of each method, each with its own seed
    #[arg(long, default_value_t = 30, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub seeds: u64,
    /// Plot of best cost against evaluations (SVG)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Where the runs themselves go (JSON), for --merge
    #[arg(long, short, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Run nothing: the joint table of these files of --out, whose seeds were run apart with otherwise the same options
    #[arg(long, num_args = 1.., value_name = "FILE", conflicts_with_all = ["seeds", "out"])]
    pub merge: Vec<PathBuf>,
    /// The model.
    #[command(flatten)]
    pub model: ModelArgs,
    /// The page.
    #[command(flatten)]
    pub page: PageArgs,
    /// The motor.
    #[command(flatten)]
    pub motor: MotorArgs,
}

/// `servoid paper`.
#[derive(Debug, Args)]
pub struct PaperArgs {
    /// Runs of each method
    #[arg(long, default_value_t = 30, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=100_000))]
    pub seeds: u64,
    /// Population
    #[arg(long, default_value_t = 5, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=64))]
    pub population: u64,
    /// Iterations
    #[arg(long, default_value_t = 1000, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    pub iterations: u64,
    /// Folder for the Bode plot and the cost curves (SVG)
    #[arg(long, value_name = "FOLDER")]
    pub plots: Option<PathBuf>,
    /// The page.
    #[command(flatten)]
    pub page: PageArgs,
    /// Length of the step response, s
    #[arg(long, default_value_t = 10.0, value_name = "S")]
    pub seconds: f64,
    /// Sample interval, s
    #[arg(long, default_value_t = 1e-3, value_name = "S")]
    pub sample: f64,
    /// Box of the six unknowns
    #[arg(
        long,
        default_value = "1e-4:1.5",
        value_name = "LOW:HIGH",
        allow_hyphen_values = true
    )]
    pub bounds: String,
}

/// Costs by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CostName {
    /// Sum of squared errors
    Squared,
    /// Integral of the absolute error, reading floored and model not (the paper's figures)
    Iae,
    /// The same with the model floored too
    IaeFloored,
    /// Likelihood of the count's cell
    Interval,
}

/// Discretisations by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// Exact for held inputs
    Exact,
    /// The paper's explicit Euler step
    Euler,
}

/// Takes `-3` behind a flag for its value, so that it is refused for what it means and under the flag's
/// name, not as an unknown flag `-3`.
fn with_negative_values(arg: Arg) -> Arg {
    let takes_value = !arg.is_positional() && arg.get_action().takes_values();
    arg.allow_negative_numbers(takes_value)
}

fn algorithm_names() -> PossibleValuesParser {
    PossibleValuesParser::new(solve::names())
}

fn effect_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Kind::ALL.iter().map(|kind| kind.name()))
}
