//! `servoid.check/1`: what recordings can be trusted for.

use super::read::Read;
use super::{PositionLoop, VERSION, finite};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::check;
use servoid_identify::repeats;
use servoid_io::recording::Recording;

/// What a check calls itself.
pub const SCHEMA: &str = "servoid.check/1";

/// `servoid.check/1`: the findings on one or several recordings.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Check {
    /// `servoid.check/1`.
    #[serde(default)]
    pub schema: String,
    /// The recordings, in the order in which they were given.
    pub recordings: Vec<Checked>,
    /// Recordings that repeat a command of each other, and those that repeat their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub repeats: Vec<Parting>,
    /// How the log was read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub read: Option<Read>,
    /// Version of the program.
    #[serde(default)]
    pub version: String,
}

/// Runs of one command, and how far the motor parts from itself.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Parting {
    /// The recordings.
    pub recordings: Vec<String>,
    /// Runs of the command: recordings, or periods of one.
    #[serde(default)]
    pub runs: usize,
    /// Length of the windows, s.
    pub window_s: Option<f64>,
    /// RMS deviation of a run from the mean of all in windows, each from where it begins, counts.
    pub in_windows_counts: Option<f64>,
    /// The same of whole runs, counts.
    pub over_run_counts: Option<f64>,
}

impl From<repeats::Parting> for Parting {
    fn from(parting: repeats::Parting) -> Self {
        Parting {
            window_s: finite(parting.window_s),
            in_windows_counts: finite(parting.in_windows),
            over_run_counts: finite(parting.over_run),
            recordings: parting.sources,
            runs: parting.runs,
        }
    }
}

/// One recording and its findings.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Checked {
    /// The recording.
    pub recording: String,
    /// Number of samples.
    pub samples: usize,
    /// From the first to the last sample, s.
    pub duration_s: Option<f64>,
    /// Median sample interval, s.
    pub interval_s: Option<f64>,
    /// Encoder counts per revolution.
    pub counts_per_rev: Option<f64>,
    /// Whether the angle is in whole counts.
    pub quantised: bool,
    /// What the command drives: `voltage` or `current`.
    pub drive: String,
    /// The position loop that makes volts of a target angle; absent where there is none. `drive` is then what the motor gets,
    /// `voltage`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_loop: Option<PositionLoop>,
    /// Largest command, V or A; behind the position loop where there is one.
    pub largest_command: Option<f64>,
    /// What was found, the gravest first.
    pub findings: Vec<Finding>,
}

/// One finding.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// What scripts know it by.
    pub code: String,
    /// `remark`, `warning` or `refusal`.
    pub severity: String,
    /// What was seen.
    pub seen: String,
    /// What to do.
    pub remedy: String,
}

impl Check {
    /// The document.
    pub fn new(recordings: Vec<Checked>) -> Self {
        Check {
            schema: SCHEMA.to_owned(),
            recordings,
            repeats: Vec::new(),
            read: None,
            version: VERSION.to_owned(),
        }
    }
}

impl Checked {
    /// A recording with what was found in it.
    pub fn new(recording: &Recording, findings: &[check::Finding]) -> Self {
        let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        Checked {
            recording: recording.source.clone(),
            samples: recording.len(),
            duration_s: finite(recording.duration_s()),
            interval_s: finite(recording.median_interval_s()),
            counts_per_rev: finite(recording.counts_per_rev),
            quantised: recording.quantised,
            drive: recording.drive.name().to_owned(),
            position_loop: (recording.position.as_ref())
                .map(|position| PositionLoop::new(&recording.source, &position.control)),
            largest_command: finite(largest),
            findings: findings
                .iter()
                .map(|finding| Finding {
                    code: finding.code.to_owned(),
                    severity: finding.severity.name().to_owned(),
                    seen: finding.seen.clone(),
                    remedy: finding.remedy.clone(),
                })
                .collect(),
        }
    }
}
