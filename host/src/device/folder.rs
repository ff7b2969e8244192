//! A run as files: recordings that every verb reads, and what the device reported.

use super::{DeviceError, DutyScale, Order, Recorded, Run};
use crate::error::Error;
use crate::input::{MotorFile, read_recording};
use crate::output::{write_recording, write_whole};
use crate::recording::{Drive, Recording};
use serde::{Deserialize, Serialize};
use shared::fit::{Estimate, Outcome, Settings, Stop};
use shared::trace::OPEN;
use shared::wire::{About, Fault, Format, Stage};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder with the files of one run.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

/// Files of a run, with the stage that each comes from.
const RECORDINGS: [(&str, Stage); 3] = [
    ("recording.csv", Stage::Excite),
    ("fitted.csv", Stage::Record),
    ("verify.csv", Stage::Verify),
];
const DEVICE: &str = "device.json";
const MOTOR: &str = "motor.toml";

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
    fn new(outcome: &Outcome, period_s: f64, order: &Order, unit_v: f64) -> Self {
        let per_count = std::f64::consts::TAU / order.counts_per_rev;
        let gain = per_count / period_s / unit_v;
        let mut measures = vec![
            ("gain", gain, "rad/s/V"),
            ("a1", period_s, "s"),
            ("electrical", period_s, "s"),
        ];
        if order.fit.coulomb {
            measures.push(("coulomb", unit_v, "V"));
        }
        if order.fit.load {
            measures.push(("load", unit_v, "V"));
        }
        let parameters =
            outcome
                .estimates
                .iter()
                .zip(measures)
                .map(|(estimate, (name, scale, unit))| {
                    let std = f64::from(estimate.std) * scale;
                    SavedParameter {
                        name: name.to_owned(),
                        value: f64::from(estimate.value) * scale,
                        unit: unit.to_owned(),
                        std: std.is_finite().then_some(std),
                    }
                });
        SavedOutcome {
            parameters: parameters.collect(),
            bits: outcome
                .estimates
                .iter()
                .map(|e| [e.value.to_bits(), e.std.to_bits()])
                .collect(),
            rms_counts: f64::from(outcome.mean_square).sqrt(),
            mean_square_bits: outcome.mean_square.to_bits(),
            evaluations: outcome.evaluations,
            converged: outcome.stop == Stop::Converged,
        }
    }

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
    fn scale(&self) -> DutyScale {
        DutyScale {
            supply_v: self.supply_v,
            full: self.full_duty,
        }
    }

    /// Of a run that came to its end.
    pub fn new(run: &Run, order: &Order) -> Self {
        let failure = run.outcome.as_ref().err();
        let report = run
            .outcome
            .as_ref()
            .ok()
            .or(failure.and_then(|failure| failure.report.as_ref()));
        let mut saved = Saved::broken(&run.about, order, &run.recorded);
        saved.partial =
            saved.missing > 0 || failure.is_some_and(|failure| failure.fault != Fault::NotVerified);
        saved.failure = failure.map(|failure| SavedFailure {
            fault: format!("{:?}", failure.fault),
            message: failure.fault.to_string(),
            stage: format!("{:?}", failure.stage).to_lowercase(),
            at_s: f64::from(failure.at) * f64::from(run.about.period_us) * 1e-6,
            seen: failure.seen,
            limit: failure.limit,
        });
        if let Some(report) = report {
            let period_s = f64::from(run.about.period_us) * 1e-6;
            let scale = saved.scale();
            saved.breakaway_v = scale.volts(report.breakaway);
            saved.amplitude_v = scale.volts(report.amplitude);
            saved.outcome = report
                .outcome
                .as_ref()
                .map(|outcome| SavedOutcome::new(outcome, period_s, order, scale.unit_v()));
            saved.verified_rms_counts = report
                .verified
                .map(|verified| f64::from(verified.mean_square).sqrt());
        }
        saved
    }

    /// Of a run whose end is not known.
    pub fn broken(about: &About, order: &Order, recorded: &[Recorded]) -> Self {
        Saved {
            schema: "servoid.device/1".to_owned(),
            board: about.board.to_string(),
            firmware: about.firmware.to_string(),
            period_us: about.period_us,
            format: match about.format {
                Format::F32 => "f32".to_owned(),
                Format::Fixed => "fixed".to_owned(),
            },
            supply_v: order.supply_v,
            full_duty: about.full,
            counts_per_rev: order.counts_per_rev,
            fit: order.fit,
            breakaway_v: 0.0,
            amplitude_v: 0.0,
            outcome: None,
            verified_rms_counts: None,
            failure: None,
            missing: recorded.iter().map(Recorded::missing).sum(),
            partial: true,
        }
    }
}

impl Folder {
    /// A folder that a run may be written to: new, or empty of runs.
    ///
    /// # Errors
    /// A folder that holds a run already, or that cannot be made.
    pub fn new(path: &Path) -> Result<Self, DeviceError> {
        let folder = Folder {
            path: path.to_owned(),
        };
        let file = folder.path.join(DEVICE);
        if file.exists() {
            return Err(DeviceError::Folder {
                path: file,
                why: "holds a run already, which is not replaced; name another folder".to_owned(),
            });
        }
        fs::create_dir_all(path).map_err(|error| DeviceError::Folder {
            path: path.to_owned(),
            why: format!("{error}; name a folder that can be made"),
        })?;
        Ok(folder)
    }

    /// A folder that holds a run.
    pub fn at(path: &Path) -> Self {
        Folder {
            path: path.to_owned(),
        }
    }

    /// Path of the recording of a stage.
    pub fn recording_of(&self, stage: Stage) -> Option<PathBuf> {
        let named = RECORDINGS.iter().find(|(_, of)| *of == stage);
        named
            .map(|(name, _)| self.path.join(name))
            .filter(|path| path.exists())
    }

    /// Writes a run; returns the names of the recordings.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(
        &self,
        saved: &Saved,
        recorded: &[Recorded],
        current: bool,
    ) -> Result<Vec<&'static str>, Error> {
        let mut written = Vec::new();
        for (name, stage) in RECORDINGS {
            let Some(part) = recorded.iter().find(|part| part.stage == stage) else {
                continue;
            };
            let whole: Vec<_> = part.whole().collect();
            if whole.len() < 2 {
                continue;
            }
            let mut provenance = vec![format!(
                "recorded by servoid device: board {}, firmware {}, {} s a period",
                saved.board,
                saved.firmware,
                f64::from(saved.period_us) * 1e-6
            )];
            if whole.len() < part.rows.len() || saved.partial {
                provenance.push(format!("partial: {} periods without a gap", whole.len()));
            }
            let recording = recording(part.count, &whole, saved, current);
            write_recording(&self.path.join(name), &recording, &provenance)?;
            written.push(name);
        }
        let motor = MotorFile {
            counts_per_rev: Some(saved.counts_per_rev),
            supply_v: Some(saved.supply_v),
            ..MotorFile::default()
        };
        write_whole(&self.path.join(MOTOR), |out| {
            out.write_all(motor.to_toml().as_bytes())
        })?;
        let json = serde_json::to_string_pretty(saved).map_err(|error| {
            Error::Failed(format!("the report cannot be written as JSON: {error}"))
        })?;
        write_whole(&self.path.join(DEVICE), |out| writeln!(out, "{json}"))?;
        Ok(written)
    }

    /// What the device reported.
    ///
    /// # Errors
    /// A file that is missing or is no report.
    pub fn saved(&self) -> Result<Saved, DeviceError> {
        let path = self.path.join(DEVICE);
        let wrong = |why: String| DeviceError::Folder {
            path: path.clone(),
            why,
        };
        let text = fs::read_to_string(&path).map_err(|error| {
            wrong(format!(
                "{error}; name a folder that `servoid device commission --out` wrote"
            ))
        })?;
        let saved: Saved = serde_json::from_str(&text)
            .map_err(|error| wrong(format!("is no report of a device: {error}")))?;
        if saved.schema != "servoid.device/1" {
            return Err(wrong(format!(
                "is of the schema `{}`; this program reads servoid.device/1",
                saved.schema
            )));
        }
        Ok(saved)
    }

    /// What the device fitted, read back: duties and steps of whole periods.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn fitted(&self, saved: &Saved) -> Result<(Vec<i16>, Vec<i16>), Error> {
        let path = self.path.join("fitted.csv");
        let motor = MotorFile::read(&self.path.join(MOTOR))?;
        let recording = read_recording(&path, &motor)?;
        let steps = recording
            .counts
            .windows(2)
            .map(|pair| (pair[1] - pair[0]) as i16)
            .collect();
        let open = |k: usize| {
            recording
                .enabled
                .as_ref()
                .is_some_and(|enabled| !enabled[k])
        };
        let duty = |(k, volts): (usize, &f64)| {
            if open(k) {
                OPEN
            } else {
                saved.scale().duty(*volts) as i16
            }
        };
        let duties = recording.command.iter().enumerate().map(duty);
        Ok((duties.take(recording.len() - 1).collect(), steps))
    }
}

/// Rows as a recording; the reading after the last period is a row of its own, with no drive.
fn recording(count: i32, rows: &[shared::wire::Row], saved: &Saved, current: bool) -> Recording {
    let period_s = f64::from(saved.period_us) * 1e-6;
    let coasts = rows.iter().any(|row| row.duty == OPEN);
    let volts = |duty: i16| {
        if duty == OPEN {
            0.0
        } else {
            saved.scale().volts(duty)
        }
    };
    let mut counts = vec![f64::from(count)];
    let mut at = f64::from(count);
    for row in rows {
        at += f64::from(row.step);
        counts.push(at);
    }
    let last = rows.last().map_or(0, |row| row.current_ma);
    let milliamps = rows.iter().map(|row| row.current_ma).chain([last]);
    Recording {
        source: String::new(),
        time_s: (0..counts.len()).map(|k| k as f64 * period_s).collect(),
        command: rows
            .iter()
            .map(|row| volts(row.duty))
            .chain([0.0])
            .collect(),
        counts,
        current_a: current.then(|| milliamps.map(|ma| f64::from(ma) * 1e-3).collect()),
        enabled: coasts.then(|| {
            rows.iter()
                .map(|row| row.duty != OPEN)
                .chain([true])
                .collect()
        }),
        counts_per_rev: saved.counts_per_rev,
        quantised: true,
        supply_v: Some(saved.supply_v),
        drive: Drive::Voltage,
    }
}
