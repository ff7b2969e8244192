//! `servoid.device/1`: the report of a device's run, as its folder holds it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shared::fit::{Estimate, Method, Settings, Stop};
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// What a device's report calls itself.
pub const SCHEMA: &str = "servoid.device/1";
/// The file of the report in the folder of a run.
pub(crate) const FILE: &str = "device.json";

/// What the device reported: `servoid.device/1`. Numbers that must keep their bits are written as bits too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DeviceRun {
    /// `servoid.device/1`.
    pub schema: String,
    /// Name of the board.
    pub board: String,
    /// Version of its firmware.
    pub firmware: String,
    /// Length of a control period, µs.
    pub period_us: u32,
    /// Format that its model runs in: `f32` or `fixed`.
    pub format: String,
    /// V.
    pub supply_v: f64,
    /// Duty that puts the whole supply across the winding.
    pub full_duty: u16,
    /// Counts a revolution.
    pub counts_per_rev: f64,
    /// How the device fitted.
    #[serde(with = "Order")]
    #[schemars(with = "Order")]
    pub fit: Settings,
    /// Voltage at which the shaft first moved, V.
    pub breakaway_v: f64,
    /// Largest voltage of the excitation, V.
    pub amplitude_v: f64,
    /// What it found; null if it did not fit.
    pub outcome: Option<Outcome>,
    /// Error of the verification on the device, counts RMS.
    pub verified_rms_counts: Option<f64>,
    /// What the numbers are good for, if they were verified: `floor` for all, `control` for gains, `no` for nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grade: Option<Grade>,
    /// Why for no more, and what to do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// How well the numbers are known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<Within>,
    /// How well they predicted what the fit had not seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub predicted: Option<Predicted>,
    /// The servo that the motor makes, where that was asked for and its numbers are good enough.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tuned: Option<Tuned>,
    /// How a servo kept to its last set-point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub followed: Option<Followed>,
    /// Why the run was given up; null if it was not.
    pub failure: Option<Failure>,
    /// Periods in which the current's limit held the drive back; what was driven is recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limited_periods: Option<u32>,
    /// Periods that never arrived, in all files.
    pub missing: usize,
    /// Whether the run is incomplete: periods are missing, or it was given up or broke off.
    pub partial: bool,
}

/// What a device's numbers are good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Grade {
    /// For nothing that they are needed for.
    No,
    /// For gains, though what the model leaves is more than the encoder's.
    Control,
    /// For all: what the model leaves is the encoder's.
    Floor,
}

impl fmt::Display for Grade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Grade::No => "no",
            Grade::Control => "control",
            Grade::Floor => "floor",
        })
    }
}

/// Parts by which numbers may be off, with a probability of 95 %; null where nothing is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Within {
    /// The gain.
    pub gain: Option<f64>,
    /// The time constant.
    pub a1: Option<f64>,
    /// Gain over time constant, the acceleration from standstill.
    pub acceleration: Option<f64>,
}

/// How well a device's model predicted what its fit had not seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Predicted {
    /// RMS of the error that grows in 50 ms, as a part of that of one who takes it that the speed stays; null if the recording was too short.
    pub by_persistence: Option<f64>,
    /// By which part the gain would differ by the verification.
    pub gain_moved: Option<f64>,
    /// By which part the time constant would.
    pub a1_moved: Option<f64>,
}

/// A servo that a device made of its motor, and the step that tried it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Tuned {
    /// Speed that the position loop asks for by the angle that is left, 1/s.
    pub position_1_s: f64,
    /// Voltage that the speed loop asks for by the speed that is left, V·s/rad.
    pub speed_v_s_rad: f64,
    /// Voltage that a speed takes, V·s/rad.
    pub back_emf_v_s_rad: f64,
    /// Voltage that friction takes.
    pub friction_v: f64,
    /// Gains of the observer by a count: counts, counts a period, parts of the supply.
    pub observer: [f64; 3],
    /// The step, counts.
    pub step_counts: i32,
    /// How the fitted motor answers it.
    pub predicted: Answer,
    /// How the motor did; null if its step was given up.
    pub measured: Option<Answer>,
    /// Whether the device keeps it over a power cut.
    #[serde(default)]
    pub kept: bool,
}

/// The last set-point of a servo, and what it reached: the angle at its end, or the mean speed of its last quarter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Followed {
    /// What is held.
    pub what: FollowedWhat,
    /// The set-point, rad from where the run began, or rad/s.
    pub set_point: f64,
    /// What was reached, in the same unit; null if the run broke off before.
    pub reached: Option<f64>,
}

/// What a servo holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FollowedWhat {
    /// An angle.
    Angle,
    /// A speed.
    Speed,
}

/// How a step was answered.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// Largest excess over the target, a part of the step.
    pub overshoot: f64,
    /// Until the angle stays within a twentieth of the step, or two counts, s.
    pub settling_s: f64,
    /// Where it was in the end, counts from the target.
    pub left_counts: f64,
}

/// What the device found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Outcome {
    /// In SI, for people.
    pub parameters: Vec<Parameter>,
    /// Bits of value and standard deviation of each, in the device's own measure.
    pub bits: Vec<[u32; 2]>,
    /// Error, counts RMS.
    pub rms_counts: f64,
    /// Bits of the mean squared error.
    pub mean_square_bits: u32,
    /// Models that were run.
    pub evaluations: u32,
    /// Whether the search came to its end.
    pub converged: bool,
}

/// A parameter that the device found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// In SI, referred to the winding.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Standard deviation; null where the recording does not determine the value.
    pub std: Option<f64>,
}

/// Why a run was given up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Failure {
    /// The fault's name.
    pub fault: String,
    /// What it means, and what to do.
    pub message: String,
    /// In which stage.
    pub stage: String,
    /// When, s since the start of the run.
    pub at_s: f64,
    /// The number that broke the limit.
    pub seen: i32,
    /// The limit, in the same unit.
    pub limit: i32,
    /// That unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
}

/// What a user is told first: when it gave up, and why.
impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "the device gave up while it was to {} after {:.2} s: {}",
            self.stage, self.at_s, self.message
        )
    }
}

/// The keys of [`Settings`], which the firmware shares and which knows nothing of schemas.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(remote = "Settings")]
#[schemars(rename = "Settings")]
struct Order {
    /// The method.
    #[schemars(with = "SearchMethod")]
    method: Method,
    /// Particles or fireflies.
    population: u8,
    /// Evaluations of the search; those of the polish come on top.
    evaluations: u16,
    /// Seed of the search.
    seed: u64,
    /// Whether Coulomb friction is searched for.
    coulomb: bool,
    /// Whether a constant load is searched for.
    load: bool,
    /// Waves of the bridge's carrier in a control period, where what its dead time takes is fitted; else zero.
    #[serde(default, skip_serializing_if = "is_zero")]
    carriers: u16,
    /// What the dead time takes by the board's own figure, in Q15 of the supply.
    #[serde(default, skip_serializing_if = "is_zero")]
    dead_time: u16,
    /// Whether the resistance of a supply that is not measured is fitted.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    supply: bool,
    /// Duty that is the whole supply; absent for 32,768.
    #[serde(default, skip_serializing_if = "is_zero")]
    full: u16,
}

fn is_zero(number: &u16) -> bool {
    *number == 0
}

/// The device's search methods.
#[derive(Serialize, Deserialize, JsonSchema)]
enum SearchMethod {
    /// Particle swarm.
    Pso,
    /// Fireflies.
    Firefly,
}

/// A report that cannot be used, with the remedy.
#[derive(Debug, thiserror::Error)]
#[error("{}: {why}", .path.display())]
pub struct ReportError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it, and what to do.
    pub why: String,
}

impl DeviceRun {
    /// Frequency of the bridge's carrier, Hz, where the fit is of what its dead time takes.
    pub fn carrier_hz(&self) -> Option<f64> {
        let period_s = f64::from(self.period_us) * 1e-6;
        (self.fit.carriers > 0).then(|| f64::from(self.fit.carriers) / period_s)
    }

    /// Dead time that the bridge's timer was told, s, where the board knows it.
    pub fn told_dead_time_s(&self) -> Option<f64> {
        let lost = f64::from(self.fit.dead_time) / f64::from(self.full_duty);
        let told = self.carrier_hz().map(|carrier| 0.5 * lost / carrier);
        told.filter(|told| *told > 0.0)
    }

    /// Reads the report of the run in `folder`.
    ///
    /// # Errors
    /// A file that is missing or is no report.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        let path = folder.join(FILE);
        DeviceRun::parse(fs::read_to_string(&path)).map_err(|why| ReportError { path, why })
    }

    fn parse(text: std::io::Result<String>) -> Result<Self, String> {
        let text = text.map_err(|error| {
            format!("{error}; name a folder that `servoid device commission --out` wrote")
        })?;
        let run: DeviceRun = serde_json::from_str(&text)
            .map_err(|error| format!("is no report of a device: {error}"))?;
        match run.schema.as_str() {
            SCHEMA => Ok(run),
            other => Err(format!(
                "is of the schema `{other}`; this program reads {SCHEMA}"
            )),
        }
    }
}

impl Outcome {
    /// As the device said it.
    pub fn outcome(&self) -> shared::fit::Outcome {
        let estimates = self.bits.iter().map(|[value, std]| Estimate {
            value: f32::from_bits(*value),
            std: f32::from_bits(*std),
        });
        shared::fit::Outcome {
            estimates: estimates.take(shared::fit::MOST).collect(),
            mean_square: f32::from_bits(self.mean_square_bits),
            evaluations: self.evaluations,
            stop: if self.converged {
                Stop::Converged
            } else {
                Stop::NoModel
            },
        }
    }

    /// The value of a parameter in SI.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.parameters
            .iter()
            .find(|parameter| parameter.name == name)
            .map(|parameter| parameter.value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_keys_of_the_order_are_those_of_the_settings() {
        let settings = Settings {
            carriers: 20,
            dead_time: 655,
            supply: true,
            full: 16_800,
            ..Settings::USUAL
        };
        let settings = serde_json::to_value(settings).expect("JSON");
        let order = Order::deserialize(&settings).expect("the same keys");
        let written = Order::serialize(&order, serde_json::value::Serializer);
        assert_eq!(written.expect("JSON"), settings);
    }
}
