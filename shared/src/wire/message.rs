//! The messages. Append only: new ones at the end of an enum, new fields nowhere but in new messages, unless
//! [`VERSION`](super::VERSION) is raised. [`ToDevice::Hello`] and [`About`] never change: they tell two peers that they do not
//! understand each other.

use super::{Fault, PlanDigest, PlanPart, Reset};
use crate::fit::{Grade, Outcome, Predicted, Settings, Verdict};
use crate::servo::{Gains, Response};
use heapless::{String, Vec};
use serde::{Deserialize, Serialize};

/// Most rows in one message.
pub const MOST_ROWS: usize = 20;

/// From the host.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToDevice {
    /// Who are you? Answered by [`ToHost::About`].
    Hello,
    /// The host is there. While the bridge drives, something must come every half second.
    Alive,
    /// Get ready. Answered by [`ToHost::Armed`] with a nonce that starts one run, soon.
    Arm,
    /// Starts a run. Answered by [`ToHost::Started`], however often it comes while that run is under way.
    Start {
        /// From [`ToHost::Armed`].
        nonce: u32,
        /// What to do.
        job: Job,
        /// The plan that a run of [`Kind::Play`] plays; the device refuses any but the one that it holds whole.
        plan: PlanDigest,
    },
    /// Open the bridge now.
    Stop,
    /// A part of a plan for [`Kind::Play`], before the start. Answered by [`ToHost::Planned`].
    Plan(PlanPart),
    /// Send the rows that the device fitted once more, from this one on.
    Resend {
        /// Index of the first row, counted from the start of the recording.
        first: u32,
    },
    /// What are you made of? Answered by [`ToHost::Details`].
    Describe,
    /// Where a run of [`Kind::Follow`] is to go.
    SetPoint(SetPoint),
}

/// A set-point of a servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SetPoint {
    /// Counts from where the run began.
    Position(i32),
    /// 65,536ths of a count a period.
    Speed(i32),
    /// To rest, and to the end of the run.
    End,
}

/// To the host.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum ToHost {
    /// Answer to a hello, and what a device says when it powers up.
    About(About),
    /// Answer to an arming.
    Armed {
        /// Starts one run.
        nonce: u32,
        /// Periods for which it does.
        periods: u32,
    },
    /// A command other than a start was refused; nothing has changed.
    Refused(Refusal),
    /// The device entered a stage.
    Stage {
        /// Which one.
        stage: Stage,
        /// Periods since the start of the run.
        at: u32,
        /// Periods that the stage will take, if that is known.
        length: u32,
        /// The run: the nonce that started it. What a link brings of an earlier one is none of this.
        run: u32,
    },
    /// What was commanded and read.
    Rows(Rows),
    /// How far the fit is.
    Fitting {
        /// Models run.
        done: u32,
        /// Models to run, about.
        of: u32,
        /// Least mean squared error so far, counts².
        least: f32,
    },
    /// The run is done.
    Report(Report),
    /// The run was given up.
    Failed(Failure),
    /// Answer to a part of a plan.
    Planned {
        /// The plan.
        of: PlanDigest,
        /// Number of its segments that the device holds, from the first on.
        held: u16,
    },
    /// Answer to a start.
    Started {
        /// The run: the nonce that started it.
        run: u32,
    },
    /// A start was refused; nothing has changed.
    NotStarted {
        /// The nonce that was to start it.
        run: u32,
        /// Why.
        why: Refusal,
    },
    /// Answer to [`ToDevice::Describe`].
    Details(Details),
}

impl ToHost {
    /// The run that the message is of; nothing for one that is of none.
    pub fn run(&self) -> Option<u32> {
        match self {
            ToHost::Stage { run, .. }
            | ToHost::Started { run }
            | ToHost::NotStarted { run, .. } => Some(*run),
            ToHost::Rows(rows) => Some(rows.run),
            ToHost::Report(report) => Some(report.run),
            ToHost::Failed(failure) => Some(failure.run),
            ToHost::About(_)
            | ToHost::Armed { .. }
            | ToHost::Refused(_)
            | ToHost::Fitting { .. }
            | ToHost::Planned { .. }
            | ToHost::Details(_) => None,
        }
    }
}

/// What a device is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct About {
    /// [`VERSION`](super::VERSION) that it speaks.
    pub version: u16,
    /// Name of the board.
    pub board: String<24>,
    /// Version of the firmware.
    pub firmware: String<16>,
    /// Length of a control period, µs.
    pub period_us: u32,
    /// Periods that it can fit.
    pub capacity: u16,
    /// Format that its model runs in.
    pub format: Format,
    /// Whether it measures the current.
    pub senses_current: bool,
    /// Different after each power-up: a host that sees it change knows that the device restarted.
    pub boot: u32,
    /// What it is doing.
    pub stage: Stage,
    /// Duty that puts the whole supply across the winding, at most 32,768. All duties are in this measure: one in which
    /// the bridge's own steps are whole numbers.
    pub full: u16,
}

/// What more there is to say of a device. Unlike [`About`], it may change with the version.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Details {
    /// What made it start.
    pub reset: Reset,
    /// Current that its bridge bears, mA; zero if that protects itself.
    pub current_limit_ma: u32,
    /// Whether it measures the supply.
    pub senses_supply: bool,
    /// Waves of its bridge's carrier in a control period; zero if its dead time need not be fitted.
    pub carriers: u16,
    /// Part of the supply that its bridge's dead time takes by the board's own figure, as a duty; zero if that is not known.
    pub dead_time: u16,
    /// How long its encoder's readings are late, µs.
    pub encoder_latency_us: u32,
    /// Its servo.
    pub servo: ServoState,
    /// Whether a servo outlives a power cut.
    pub keeps_servo: bool,
}

/// A device's servo.
// The first is a zero, so that a static of it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum ServoState {
    /// Nothing was tuned.
    None,
    /// It was tuned before the last power-up: whether the motor is still that one is to be seen.
    Untried,
    /// It is the motor's.
    Tried,
}

/// A number format of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    /// Single precision.
    F32,
    /// Fixed point, 64 bits with 32-bit products.
    Fixed,
}

/// What the device is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stage {
    /// Waits for a start; the bridge is open.
    Idle,
    /// Small growing steps until the shaft moves.
    Probe,
    /// Plays the long excitation, which is streamed and not kept.
    Excite,
    /// Plays and keeps what it will fit.
    Record,
    /// Fits; the bridge is open.
    Fit,
    /// Drives what the fit has not seen.
    Verify,
    /// Done or given up; the bridge is open.
    Report,
    /// Computes gains, and simulates a step with them; the bridge is open.
    Simulate,
    /// Drives the step in a closed loop.
    Tune,
    /// Follows set-points in a closed loop.
    Follow,
    /// Saves the servo where it outlives a power cut; the bridge is open, and a while nothing is heard of the device.
    Keep,
}

/// Why a command was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Refusal {
    /// A run is under way.
    Busy,
    /// The nonce is not the one of the last arming, or too old.
    NotArmed,
    /// A limit or a length is zero or beyond the device.
    BadJob,
    /// The plan is too long for the device, or not the one that it holds.
    BadPlan,
    /// There is no servo: the device was not tuned since it powered up, and keeps none from before.
    NotTuned,
}

/// What kind of run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Kind {
    /// Probe, excite, record, fit, verify.
    Commission,
    /// Probe and excite only.
    Record,
    /// Play the plan that was uploaded.
    Play,
    /// As [`Commission`](Kind::Commission); then simulate and tune, if the numbers are good enough for it.
    Tune,
    /// Follow set-points with the servo of the last [`Tune`](Kind::Tune). Where that was before the last power-up, the run begins with a
    /// verification, which says whether the motor is still that one.
    Follow,
}

impl Kind {
    /// Whether the device fits.
    #[must_use]
    pub fn fits(self) -> bool {
        matches!(self, Kind::Commission | Kind::Tune)
    }
}

/// A run as ordered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Job {
    /// What kind of run.
    pub kind: Kind,
    /// Largest duty of the excitations.
    pub amplitude: i16,
    /// Periods of the long excitation; none if zero.
    pub excite: u32,
    /// Whether the bridge opens in the pauses of the long excitation.
    pub coast: bool,
    /// Periods to record and fit, at most the device's capacity.
    pub record: u16,
    /// Periods of the verification.
    pub verify: u32,
    /// Largest error of fit and verification that is an encoder's, hundredths of a count RMS.
    pub verify_within: u32,
    /// The least that the model must be good for, or the run fails.
    pub accept: Grade,
    /// Seed of the excitations.
    pub seed: u64,
    /// How to fit.
    pub fit: Settings,
    /// What must not be exceeded.
    pub limits: Limits,
    /// Counts of a revolution, which tell the device how much travel is a motion.
    pub counts_per_rev: u32,
    /// Supply voltage, mV, that duties are parts of.
    pub supply_mv: u32,
}

/// Limits that the device watches. Zero means none, but for the duty and the time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Limits {
    /// Largest duty of any drive; at least 1.
    pub duty: i16,
    /// Counts either way from where the run began.
    pub travel: u32,
    /// Counts a period.
    pub speed: u16,
    /// mA.
    pub current_ma: u32,
    /// Current that the winding bears forever, mA.
    pub continuous_ma: u32,
    /// Thermal time constant of the winding, periods.
    pub thermal: u32,
    /// Current at full drive and standstill, mA: what a board without a current sensor assumes.
    pub stall_ma: u32,
    /// Longest run, periods; at least 1.
    pub time: u32,
}

impl Limits {
    /// Nothing is watched.
    pub const NONE: Limits = Limits {
        duty: i16::MAX,
        travel: 0,
        speed: 0,
        current_ma: 0,
        continuous_ma: 0,
        thermal: 0,
        stall_ma: 0,
        time: u32::MAX,
    };
}

/// Consecutive periods.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rows {
    /// The run: the nonce that started it.
    pub run: u32,
    /// Stage in which they were made.
    pub stage: Stage,
    /// Index of the first one, counted from the start of the stage.
    pub first: u32,
    /// Encoder reading at its start.
    pub count: i32,
    /// The periods.
    pub rows: Vec<Row, MOST_ROWS>,
}

/// One period.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Row {
    /// Duty across the winding during it in parts of the job's supply, or [`OPEN`](crate::trace::OPEN). A board that measures its
    /// supply tells what that makes of the duty that it gave.
    pub duty: i16,
    /// Counts travelled during it.
    pub step: i16,
    /// Current at its start, mA, saturated; zero without a sensor.
    pub current_ma: i16,
    /// Supply voltage at its end, mV; zero where it is not measured.
    pub supply_mv: u16,
}

/// How a run ended well.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Report {
    /// The run: the nonce that started it.
    pub run: u32,
    /// Duty at which the shaft first moved.
    pub breakaway: i16,
    /// Largest duty of the excitation, after the probe.
    pub amplitude: i16,
    /// Periods played, over all stages.
    pub periods: u32,
    /// Of these, periods in which the current's limit held the drive back.
    pub limited: u32,
    /// The fit, if one was asked for.
    pub outcome: Option<Outcome>,
    /// How well it predicts, if that was asked for.
    pub verified: Option<Predicted>,
    /// What it is good for, if that was asked for.
    pub verdict: Option<Verdict>,
    /// The servo that it makes, if that was asked for.
    pub tuned: Option<Tuned>,
}

/// A servo, and the step that tried it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tuned {
    /// Its gains.
    pub gains: Gains,
    /// The step, counts.
    pub step: i32,
    /// How the fitted motor answers it.
    pub predicted: Response,
    /// How the motor did; nothing if its step was given up.
    pub measured: Option<Response>,
    /// Whether it outlives a power cut.
    pub kept: bool,
}

/// How a run was given up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Failure {
    /// The run: the nonce that started it.
    pub run: u32,
    /// Why.
    pub fault: Fault,
    /// In which stage.
    pub stage: Stage,
    /// Periods since the start of the run.
    pub at: u32,
    /// The number that broke the limit, in the limit's unit; zero if there is none.
    pub seen: i32,
    /// The limit.
    pub limit: i32,
    /// What was found before, if anything.
    pub report: Option<Report>,
}
