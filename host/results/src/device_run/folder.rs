//! A run as files: recordings that every verb reads, and what the device reported.

use super::live::left_in;
use super::{DutyScale, FolderError, Piece, Recorded};
use crate::schema::DeviceRun;
use crate::schema::device::FILE as DEVICE;
use servoid_io::channel::{Measured, Series};
use servoid_io::input::{Fact, Known, MotorFile, read_recording};
use servoid_io::output::{write_recording, write_whole};
use servoid_io::recording::{Drive, Recording};
use shared::trace::OPEN;
use shared::wire::Stage;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder with the files of one run.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
}

/// Files of a run, with the stage that each comes from.
pub(super) const RECORDINGS: [(&str, Stage); 5] = [
    ("recording.csv", Stage::Excite),
    ("fitted.csv", Stage::Record),
    ("verify.csv", Stage::Verify),
    ("tune.csv", Stage::Tune),
    ("follow.csv", Stage::Follow),
];
pub(super) const MOTOR: &str = "motor.toml";
/// Fewest periods of a piece behind a gap that are written: fewer say nothing about a motor.
const LEAST_PIECE: usize = 100;

impl Folder {
    /// A folder that a run may be written to: new, or empty of runs.
    ///
    /// # Errors
    /// A folder that holds a run already, or that cannot be made.
    pub fn new(path: &Path) -> Result<Self, FolderError> {
        let folder = Folder {
            path: path.to_owned(),
        };
        let file = folder.path.join(DEVICE);
        if file.exists() {
            return Err(FolderError::Unusable {
                path: file,
                why: "holds a run already, which is not replaced; name another folder".to_owned(),
            });
        }
        if let Some(file) = left_in(path) {
            return Err(FolderError::Unusable {
                path: file,
                why:
                    "is what an unfinished run has left, which is not replaced; name another folder"
                        .to_owned(),
            });
        }
        fs::create_dir_all(path).map_err(|error| FolderError::Unusable {
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

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
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
        saved: &DeviceRun,
        recorded: &[Recorded],
        current: bool,
    ) -> Result<Vec<String>, FolderError> {
        let mut written = Vec::new();
        for (name, stage) in RECORDINGS {
            let Some(part) = recorded.iter().find(|part| part.stage == stage) else {
                continue;
            };
            let pieces = part.pieces();
            let long = |piece: &&Piece| match piece.first {
                0 => piece.rows.len() >= 2,
                _ => piece.rows.len() >= LEAST_PIECE,
            };
            for (k, piece) in pieces.iter().filter(long).enumerate() {
                let name = piece_name(name, k);
                let mut provenance = vec![format!(
                    "recorded by servoid device: board {}, firmware {}, {} s a period",
                    saved.board,
                    saved.firmware,
                    f64::from(saved.period_us) * 1e-6
                )];
                if piece.rows.len() < part.rows.len() || saved.partial {
                    let end = piece.first + piece.rows.len();
                    provenance.push(format!(
                        "partial: periods {} to {end} of {}, without a gap",
                        piece.first,
                        part.rows.len()
                    ));
                }
                let recording = recording(
                    piece,
                    saved.period_us,
                    saved.scale(),
                    saved.counts_per_rev,
                    current,
                );
                write_recording(&self.path.join(&name), &recording, &provenance)?;
                written.push(name);
            }
        }
        let motor = motor_file(saved.supply_v, saved.counts_per_rev, behind(saved));
        write_whole(&self.path.join(MOTOR), |out| {
            out.write_all(motor.as_bytes())
        })?;
        let json = serde_json::to_string_pretty(saved).map_err(|error| FolderError::Unusable {
            path: self.path.join(DEVICE),
            why: format!("the report cannot be written as JSON: {error}"),
        })?;
        write_whole(&self.path.join(DEVICE), |out| writeln!(out, "{json}"))?;
        Ok(written)
    }

    /// What the device reported.
    ///
    /// # Errors
    /// A file that is missing or is no report.
    pub fn saved(&self) -> Result<DeviceRun, FolderError> {
        Ok(DeviceRun::read(&self.path)?)
    }

    /// What the device fitted, read back: duties and steps of whole periods.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn fitted(&self, saved: &DeviceRun) -> Result<(Vec<i16>, Vec<i16>), FolderError> {
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

/// The motor file of a run.
pub(super) fn motor_file(supply_v: f64, counts_per_rev: f64, known: Known) -> String {
    MotorFile {
        counts_per_rev: Some(counts_per_rev),
        supply_v: Some(supply_v),
        known,
        ..MotorFile::default()
    }
    .to_toml()
}

/// What the board says of its bridge.
fn behind(saved: &DeviceRun) -> Known {
    let exact = |value| Fact {
        value,
        tolerance: None,
    };
    Known {
        carrier_hz: saved.carrier_hz().map(exact),
        dead_time_s: saved.told_dead_time_s().map(exact),
        ..Known::default()
    }
}

/// The name of a stage's piece, of which the first has the stage's own: `verify.csv`, `verify.2.csv`.
fn piece_name(name: &str, index: usize) -> String {
    match (index, name.rsplit_once('.')) {
        (1.., Some((stem, end))) => format!("{stem}.{}.{end}", index + 1),
        _ => name.to_owned(),
    }
}

/// A piece of a stage as a recording; the reading after the last period is a row of its own, with no drive.
pub fn recording(
    piece: &Piece,
    period_us: u32,
    scale: DutyScale,
    counts_per_rev: f64,
    current: bool,
) -> Recording {
    let rows = &piece.rows;
    let period_s = f64::from(period_us) * 1e-6;
    let coasts = rows.iter().any(|row| row.duty == OPEN);
    let mut at = f64::from(piece.count);
    let mut counts = vec![at];
    for row in rows {
        at += f64::from(row.step);
        counts.push(at);
    }
    let last = rows.last().map_or(0, |row| row.current_ma);
    let milliamps = rows.iter().map(|row| row.current_ma).chain([last]);
    Recording {
        source: String::new(),
        time_s: (piece.first..)
            .map(|k| k as f64 * period_s)
            .take(counts.len())
            .collect(),
        command: rows
            .iter()
            .map(|row| scale.recorded(row.duty))
            .chain([0.0])
            .collect(),
        counts,
        measured: Series::NONE.with(
            Measured::Current,
            current.then(|| milliamps.map(|ma| f64::from(ma) * 1e-3).collect()),
        ),
        enabled: coasts.then(|| {
            rows.iter()
                .map(|row| row.duty != OPEN)
                .chain([true])
                .collect()
        }),
        counts_per_rev,
        quantised: true,
        supply_v: Some(scale.supply_v),
        drive: Drive::Voltage,
        position: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device_run::recorded::message;

    #[test]
    fn what_lies_behind_a_gap_is_a_recording_at_its_own_time_and_angle() {
        let report = include_str!("../../tests/documents/device.json");
        let saved: DeviceRun = serde_json::from_str(report).expect("a report");
        let place = tempfile::tempdir().expect("a place");
        let folder = Folder::new(place.path()).expect("a folder");
        let mut recorded = Recorded::new(Stage::Excite, 0);
        // Of 400 periods, 160 to 167 and 200 to 207 are lost; what lies between is too short to say anything.
        for first in (0..400).step_by(8) {
            if first != 160 && first != 200 {
                // A shaft that goes on by two counts a period.
                recorded.take(&message(first, 2 * first as i32, &[2; 8]));
            }
        }
        let written = folder.write(&saved, &[recorded], false).expect("written");
        assert_eq!(written, ["recording.csv", "recording.2.csv"]);
        let motor = MotorFile::read(&folder.path().join(MOTOR)).expect("a motor file");
        let piece =
            read_recording(&folder.path().join("recording.2.csv"), &motor).expect("a recording");
        let period_s = f64::from(saved.period_us) * 1e-6;
        assert_eq!((piece.len(), piece.counts[0]), (193, 416.0));
        assert!((piece.time_s[0] - 208.0 * period_s).abs() < 1e-9);
    }
}
