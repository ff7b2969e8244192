//! `servoid simulate`, and planning the next recording.

use super::{FormulaArgs, effect_names};
use clap::{ArgGroup, Args};
use std::path::PathBuf;

/// `servoid simulate`.
#[derive(Debug, Args)]
pub struct SimulateArgs {
    /// Motor on the bench (see --list)
    #[arg(
        long,
        default_value = "gearmotor",
        value_name = "NAME",
        conflicts_with = "after"
    )]
    pub machine: String,
    /// Hide an effect in it: a name, or name:key=value,key=value; may be repeated
    #[arg(long, value_name = "EFFECT", conflicts_with = "plan")]
    pub hide: Vec<String>,
    /// Laws of your own that are hidden too, with the values that they state.
    #[command(flatten)]
    pub formulas: FormulaArgs,
    /// Excitation: commissioning, commissioning-coast, or the name of one shape (see --list)
    #[arg(
        long,
        default_value = "commissioning",
        value_name = "NAME",
        conflicts_with = "plan"
    )]
    pub excite: String,
    /// Length, s; if not given, the usual one of the excitation, and 20 of a plan
    #[arg(long, value_name = "S")]
    pub seconds: Option<f64>,
    /// Amplitude, as a part of the supply (with --drive position of --reach)
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "PART",
        conflicts_with = "plan"
    )]
    pub amplitude: f64,
    /// What the excitation sets: the voltage, or a target angle behind which the drive closes a position loop
    #[arg(long, value_name = "voltage|position", value_parser = ["voltage", "position"], conflicts_with = "plan")]
    pub drive: Option<String>,
    /// Of the position loop: gain_v_per_rad, damping_v_s_per_rad, limit_v, dead_band_rad or rate_hz, as in gain_v_per_rad=3
    #[arg(long = "loop", value_name = "WHAT=VALUE", conflicts_with = "plan")]
    pub position_loop: Vec<String>,
    /// Largest target with --drive position, revolutions
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "REV",
        conflicts_with = "plan"
    )]
    pub reach: f64,
    /// Sample interval, s
    #[arg(
        long,
        default_value_t = 1e-3,
        value_name = "S",
        conflicts_with = "after"
    )]
    pub sample: f64,
    /// Largest deviation of a sample's time, s
    #[arg(long, default_value_t = 0.0, value_name = "S", conflicts_with = "plan")]
    pub jitter: f64,
    /// Encoder counts per revolution
    #[arg(
        long,
        default_value_t = 2000,
        value_name = "N",
        conflicts_with = "after"
    )]
    pub counts_per_rev: u32,
    /// Also record the current
    #[arg(long, conflicts_with = "plan")]
    pub current: bool,
    /// Noise of the current sensor, A
    #[arg(long, default_value_t = 0.0, value_name = "A", conflicts_with = "plan")]
    pub current_noise: f64,
    /// Noise of the angle sensor before it is floored, standard deviation, counts
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "COUNTS",
        conflicts_with = "plan"
    )]
    pub angle_noise: f64,
    /// Load torque that is another one in each sample interval, standard deviation, as a part of the stall torque
    #[arg(
        long,
        default_value_t = 0.0,
        value_name = "PART",
        conflicts_with = "plan"
    )]
    pub torque_noise: f64,
    /// Substeps of the plant a second
    #[arg(long, value_name = "HZ", conflicts_with = "plan")]
    pub substep_hz: Option<f64>,
    /// Where the recording goes, with motor.toml beside it, or the plan's commands
    #[arg(long, short, required_unless_present = "list", value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Do not write motor.toml beside the recording
    #[arg(long, conflicts_with = "plan")]
    pub no_motor: bool,
    /// List motors, effects and excitations
    #[arg(long, conflicts_with = "plan")]
    pub list: bool,
    /// The plan.
    #[command(flatten)]
    pub plan: PlanArgs,
}

/// `servoid simulate --plan`.
#[derive(Debug, Args)]
#[command(next_help_heading = "Planning the next recording")]
#[group(skip)]
#[command(group = ArgGroup::new("rivals").args(["between", "after"]))]
pub struct PlanArgs {
    /// Find the excitation that separates effects which look alike, and write its commands
    #[arg(long, requires = "rivals")]
    pub plan: bool,
    /// Separate these effects, each with typical values on --machine
    #[arg(long, value_delimiter = ',', value_name = "EFFECT,…", requires = "plan", value_parser = effect_names())]
    pub between: Vec<String>,
    /// Separate the models of this diagnosis: what `servoid diagnose --json FILE` wrote
    #[arg(long, value_name = "FILE", requires = "plan")]
    pub after: Option<PathBuf>,
    /// Largest voltage, V; the supply's if not given
    #[arg(long, value_name = "V", requires = "plan")]
    pub max_voltage: Option<f64>,
    /// Largest current, A; needs --resistance
    #[arg(long, value_name = "A", requires = "plan")]
    pub max_current: Option<f64>,
    /// Armature resistance, ohm, which turns the model's volts into amperes
    #[arg(long, value_name = "OHM", requires = "plan")]
    pub resistance: Option<f64>,
    /// Travel of the shaft from end to end, revolutions
    #[arg(long, value_name = "REV", requires = "plan")]
    pub travel: Option<f64>,
}
