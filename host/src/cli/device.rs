//! The shape of `servoid device`.

use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

/// `servoid device`.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct DeviceArgs {
    /// What to do with it.
    #[command(subcommand)]
    pub verb: DeviceVerb,
}

const EXAMPLES: &str = "Examples:
  servoid device list
  servoid device info --port /dev/ttyACM0
  servoid device commission --port /dev/ttyACM0 --supply-v 24 --counts-per-rev 2000 --out bench3
  servoid device commission --emulate --hide cogging --out trial
  servoid device verify trial
  servoid device bench --port /dev/ttyACM0 --supply-v 24 --counts-per-rev 2000 --max-current 4 --resistance 1.1

Ctrl-C stops the motor and keeps what was recorded. A device whose host falls silent stops by itself.";

/// What to do with a device.
#[derive(Debug, Subcommand)]
pub enum DeviceVerb {
    /// Lists the serial ports of this machine
    List,
    /// Asks a device what it is
    Info(OnDevice),
    /// Has the motor identify itself: probe, excite, record, fit, verify
    Commission(CommissionArgs),
    /// Commissions a motor, computes the gains of a position and a speed loop on the device, and tries them by a step there
    Tune(CommissionArgs),
    /// Has the servo that `tune` made follow angles or speeds, and records
    Follow(FollowArgs),
    /// Excites the motor and records, without a fit on the device
    Record(RecordArgs),
    /// As record, and prints each period as a line of CSV as it comes
    Stream(StreamArgs),
    /// Plays the command sequence that `servoid simulate --plan` wrote, and records
    Run(RunArgs),
    /// Repeats the device's fit bit for bit, fits with stronger methods, diagnoses, and says whether its answer stands
    Verify(VerifyArgs),
    /// Opens the workbench with a device: its motor is recorded, watched and commissioned from the page
    Bench(DeviceBenchArgs),
    /// Stops whatever a device is doing
    Stop(OnDevice),
    /// Starts an emulated device and keeps it running, for other programs to talk to
    Emulate(EmulateArgs),
}

/// Which device.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "The device")]
pub struct PortArgs {
    /// Where it is: a serial port (with :BAUD if not 921600), tcp:HOST:PORT or unix:PATH
    #[arg(
        long,
        value_name = "ADDRESS",
        required_unless_present = "emulate",
        conflicts_with = "emulate"
    )]
    pub port: Option<String>,
    /// No hardware: the firmware in emulation, with the virtual bench as its motor
    #[arg(long)]
    pub emulate: bool,
    /// The emulation.
    #[command(flatten)]
    pub emulation: EmulationArgs,
}

/// An emulated device.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "The emulated device")]
pub struct EmulationArgs {
    /// Image of the firmware: an ARM one runs in QEMU, a native one by itself; if not given, what `scripts/emulated` built
    #[arg(long, value_name = "FILE")]
    pub image: Option<PathBuf>,
    /// Motor on the bench (see servoid simulate --list)
    #[arg(long, default_value = "gearmotor", value_name = "NAME")]
    pub machine: String,
    /// Hide an effect in it: a name, or name:key=value,key=value; may be repeated
    #[arg(long, value_name = "EFFECT")]
    pub hide: Vec<String>,
    /// Times as fast as a real bench, at most
    #[arg(long, default_value_t = 4.0, value_name = "FACTOR")]
    pub pace: f64,
}

/// A verb that only needs to know which device.
#[derive(Clone, Debug, Args)]
pub struct OnDevice {
    /// The device.
    #[command(flatten)]
    pub port: PortArgs,
}

/// What is known of the bench, and what must not be exceeded.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "The bench and its limits")]
pub struct LimitArgs {
    /// Supply voltage, V; an emulated bench knows its own
    #[arg(
        long = "supply-v",
        value_name = "V",
        required_unless_present = "emulate"
    )]
    pub supply: Option<f64>,
    /// Encoder counts per revolution; an emulated bench has 2000 if not told otherwise
    #[arg(long, value_name = "N", required_unless_present = "emulate")]
    pub counts_per_rev: Option<u32>,
    /// Largest drive of the excitation, as a part of the supply
    #[arg(long, default_value_t = 0.95, value_name = "PART")]
    pub amplitude: f64,
    /// Largest voltage of any drive, V
    #[arg(long, value_name = "V")]
    pub max_voltage: Option<f64>,
    /// Largest current, A
    #[arg(long, value_name = "A")]
    pub max_current: Option<f64>,
    /// Travel either way from where the shaft stands, revolutions; unlimited if not given
    #[arg(long, value_name = "REV")]
    pub max_travel: Option<f64>,
    /// Largest speed, rad/s
    #[arg(long, value_name = "RAD/S")]
    pub max_speed: Option<f64>,
    /// Current that the winding bears forever, A
    #[arg(long, value_name = "A", requires = "thermal_time")]
    pub continuous_current: Option<f64>,
    /// Thermal time constant of the winding, s
    #[arg(long, value_name = "S", requires = "continuous_current")]
    pub thermal_time: Option<f64>,
    /// Armature resistance, ohm: lets a board without a current sensor guess the current
    #[arg(long, value_name = "OHM")]
    pub resistance: Option<f64>,
}

/// `servoid device bench`.
#[derive(Clone, Debug, Args)]
pub struct DeviceBenchArgs {
    /// The device.
    #[command(flatten)]
    pub port: PortArgs,
    /// The bench.
    #[command(flatten)]
    pub limits: LimitArgs,
    /// Keep the files of each run in a folder of its own in this one; else they end with the program
    #[arg(long, value_name = "FOLDER")]
    pub runs: Option<PathBuf>,
    /// Do not open the bridge in the pauses of excitations
    #[arg(long)]
    pub no_coast: bool,
    /// Keep the bench in this file, and go on with what is in it
    #[arg(long, value_name = "FILE")]
    pub session: Option<PathBuf>,
    /// Do not open a browser
    #[arg(long)]
    pub no_open: bool,
    /// Port of the page on 127.0.0.1; a free one if zero
    #[arg(long, default_value_t = 0, value_name = "PORT")]
    pub page_port: u16,
}

/// On or off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Switch {
    /// Yes
    On,
    /// No
    Off,
}

/// Search methods on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum DeviceMethod {
    /// Particle swarm
    Pso,
    /// Fireflies
    Firefly,
}

/// `servoid device commission`.
#[derive(Clone, Debug, Args)]
pub struct CommissionArgs {
    /// Folder for the recordings and the device's report; it must not hold a run yet
    #[arg(long, short, value_name = "FOLDER")]
    pub out: PathBuf,
    /// Length of the long excitation for the diagnosis on the host, s
    #[arg(long, default_value_t = 20.0, value_name = "S")]
    pub excite: f64,
    /// Do not open the bridge in its pauses
    #[arg(long)]
    pub no_coast: bool,
    /// Fit what the bridge's dead time takes, too; on where the board knows how often its bridge switches
    #[arg(long, value_enum, value_name = "WHETHER", num_args = 0..=1, require_equals = true, default_missing_value = "on")]
    pub dead_time: Option<Switch>,
    /// Length of the recording that the device fits, s; what it can hold if not given
    #[arg(long, value_name = "S")]
    pub record: Option<f64>,
    /// Length of the verification, s
    #[arg(long, default_value_t = 4.0, value_name = "S")]
    pub verify: f64,
    /// Most that fit and verification may leave, counts RMS, for the run to be a success; 0 takes any. Without it, a motor whose numbers are
    /// good for control is a success, and what an encoder leaves is 1 count, or a 4,096th of a revolution if that is more
    #[arg(long, value_name = "COUNTS")]
    pub verify_within: Option<f64>,
    /// Search method on the device
    #[arg(long, value_enum, default_value_t = DeviceMethod::Firefly)]
    pub algorithm: DeviceMethod,
    /// Particles or fireflies
    #[arg(long, default_value_t = 20, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=20))]
    pub population: u8,
    /// Model evaluations of the device's search
    #[arg(long, default_value_t = 4000, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub budget: u16,
    /// Effects that the device fits beside the linear machine; --with '' for none
    #[arg(long, value_delimiter = ',', default_value = "coulomb", value_name = "EFFECT,…", value_parser = fitted_names())]
    pub with: Vec<String>,
    /// The device.
    #[command(flatten)]
    pub port: PortArgs,
    /// The bench.
    #[command(flatten)]
    pub limits: LimitArgs,
}

/// `servoid device follow`.
#[derive(Clone, Debug, Args)]
pub struct FollowArgs {
    /// Table of set-points: t_s, and angle_rad from where the shaft stands or speed_rad_s; each holds until the next
    #[arg(required_unless_present_any = ["angle", "speed"], conflicts_with_all = ["angle", "speed"])]
    pub course: Option<PathBuf>,
    /// One angle, rad from where the shaft stands
    #[arg(
        long,
        value_name = "RAD",
        allow_negative_numbers = true,
        conflicts_with = "speed"
    )]
    pub angle: Option<f64>,
    /// One speed, rad/s
    #[arg(long, value_name = "RAD/S", allow_negative_numbers = true)]
    pub speed: Option<f64>,
    /// How long the last set-point holds, s
    #[arg(long = "for", default_value_t = 2.0, value_name = "S")]
    pub seconds: f64,
    /// Folder for the recording; it must not hold a run yet
    #[arg(long, short, value_name = "FOLDER")]
    pub out: PathBuf,
    /// The device.
    #[command(flatten)]
    pub port: PortArgs,
    /// The bench.
    #[command(flatten)]
    pub limits: LimitArgs,
}

/// `servoid device record`.
#[derive(Clone, Debug, Args)]
pub struct RecordArgs {
    /// Folder for the recording; it must not hold a run yet
    #[arg(long, short, value_name = "FOLDER")]
    pub out: PathBuf,
    /// The excitation.
    #[command(flatten)]
    pub stream: StreamArgs,
}

/// `servoid device stream`.
#[derive(Clone, Debug, Args)]
pub struct StreamArgs {
    /// Length, s
    #[arg(long, default_value_t = 20.0, value_name = "S")]
    pub seconds: f64,
    /// Do not open the bridge in the pauses
    #[arg(long)]
    pub no_coast: bool,
    /// The device.
    #[command(flatten)]
    pub port: PortArgs,
    /// The bench.
    #[command(flatten)]
    pub limits: LimitArgs,
}

/// `servoid device run`.
#[derive(Clone, Debug, Args)]
pub struct RunArgs {
    /// The command sequence
    pub plan: PathBuf,
    /// Folder for the recording; it must not hold a run yet
    #[arg(long, short, value_name = "FOLDER")]
    pub out: PathBuf,
    /// The device.
    #[command(flatten)]
    pub port: PortArgs,
    /// The bench.
    #[command(flatten)]
    pub limits: LimitArgs,
}

/// `servoid device verify`.
#[derive(Clone, Debug, Args)]
pub struct VerifyArgs {
    /// Folder that `servoid device commission --out` wrote
    pub folder: PathBuf,
}

/// `servoid device emulate`.
#[derive(Clone, Debug, Args)]
pub struct EmulateArgs {
    /// Encoder counts per revolution
    #[arg(long, default_value_t = 2000, value_name = "N")]
    pub counts_per_rev: u32,
    /// The emulation.
    #[command(flatten)]
    pub emulation: EmulationArgs,
}

/// What the device can fit, and nothing.
fn fitted_names() -> clap::builder::PossibleValuesParser {
    clap::builder::PossibleValuesParser::new(["coulomb", "load_torque", ""])
}
