//! The report of a device's run, as it is written: `servoid.device/1`.

use super::DutyScale;
use serde::{Deserialize, Serialize};
use shared::fit::{Estimate, Outcome, Settings, Stop};

/// What the device reported, as it is kept: `servoid.device/1`. Numbers that must keep their bits are kept as bits too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Saved {
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
    pub fit: Settings,
    /// Voltage at which the shaft first moved, V.
    pub breakaway_v: f64,
    /// Largest voltage of the excitation, V.
    pub amplitude_v: f64,
    /// What it found; none if it did not fit.
    pub outcome: Option<SavedOutcome>,
    /// Error of the verification on the device, counts RMS.
    pub verified_rms_counts: Option<f64>,
    /// Why the run was given up; none if it was not.
    pub failure: Option<SavedFailure>,
    /// Periods that never arrived, in all files.
    pub missing: usize,
    /// Whether the run is incomplete: periods are missing, or it was given up or broke off.
    pub partial: bool,
}

/// What the device found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedOutcome {
    /// In SI, for people.
    pub parameters: Vec<SavedParameter>,
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedParameter {
    /// Its name.
    pub name: String,
    /// In SI, referred to the winding.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Standard deviation; none where the recording does not determine the value.
    pub std: Option<f64>,
}

/// Why a run was given up.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedFailure {
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
}

impl SavedOutcome {
    /// As the device said it.
    pub fn outcome(&self) -> Outcome {
        let estimates = self.bits.iter().map(|[value, std]| Estimate {
            value: f32::from_bits(*value),
            std: f32::from_bits(*std),
        });
        Outcome {
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

impl Saved {
    /// What the device's duties are worth.
    pub fn scale(&self) -> DutyScale {
        DutyScale {
            supply_v: self.supply_v,
            full: self.full_duty,
        }
    }
}
