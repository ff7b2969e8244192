//! What a user knows about a motor and its log: the contents of `motor.toml`.

use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

use super::log_part::LogPart;
use super::motor_error::{MotorFault, MotorFileError};
use super::motor_units::Units;
use super::place::Place;
use crate::channel::Channel;
use crate::position_loop::LoopSettings;
use crate::recording::Drive;

/// A motor file larger than this is something else.
pub const MAX_FILE_BYTES: u64 = 1 << 20;

/// The contents of a `motor.toml`. The default means "nothing known": the contract's columns and units, a
/// voltage drive and no facts. Every number is finite and greater than zero.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorFile {
    /// The file's path for messages; `None` where there is no file.
    pub source: Option<String>,
    /// The user's name of the motor or bench.
    pub name: Option<String>,
    /// Encoder counts per revolution, all edges counted.
    pub counts_per_rev: Option<f64>,
    /// Supply voltage, V.
    pub supply_v: Option<f64>,
    /// Travel per revolution of a linear axis, m.
    pub metres_per_rev: Option<f64>,
    /// Names of the columns in the recording.
    pub columns: Columns,
    /// Units of the columns in the recording.
    pub units: Units,
    /// What the motor gets.
    pub drive: Drive,
    /// Whether a user says so: nothing else is guessed then.
    pub drive_said: bool,
    /// What is said of the position loop, where the command is a target angle.
    pub position: Option<LoopSettings>,
    /// Facts from a datasheet or a meter.
    pub known: Known,
    /// Which part of the log is meant.
    pub log: LogPart,
}

/// Names of the recording's columns, where they are not the contract's own. The command's is that of the targets in the file of a
/// position drive.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Columns(BTreeMap<Channel, String>);

/// Facts about the motor, SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Known {
    /// Armature resistance, Ω.
    pub resistance_ohm: Option<Fact>,
    /// Armature inductance, H.
    pub inductance_h: Option<Fact>,
    /// Torque constant, N·m/A.
    pub kt_n_m_a: Option<Fact>,
    /// Back-EMF constant, V·s/rad.
    pub kb_v_s_rad: Option<Fact>,
    /// Moment of inertia of rotor and load, kg·m².
    pub inertia_kg_m2: Option<Fact>,
    /// Viscous friction, N·m·s/rad.
    pub viscous_n_m_s: Option<Fact>,
    /// Largest torque of an eccentric weight on the shaft, `m·g·l`, N·m: of a pendulum, an arm, a mass that was put on.
    pub unbalance_n_m: Option<Fact>,
    /// Frequency of the carrier of the bridge that drives the motor, Hz.
    pub carrier_hz: Option<Fact>,
    /// Dead time that the bridge's timer was told, s.
    pub dead_time_s: Option<Fact>,
    /// Whether torque and back-EMF constant are one number, as they are in SI units without iron losses.
    pub kt_equals_kb: bool,
}

/// A known value: a constant, or with a tolerance a prior.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fact {
    /// The value in the unit of its key; positive.
    pub value: f64,
    /// Relative tolerance, 0 … 1 exclusive; `None` for a constant.
    pub tolerance: Option<f64>,
}

impl Columns {
    /// The name of a channel's column, if the user gives one.
    pub fn get(&self, channel: Channel) -> Option<&str> {
        self.0.get(&channel).map(String::as_str)
    }

    /// Names a channel's column; nothing for none.
    pub fn set(&mut self, channel: Channel, name: Option<String>) {
        match name {
            Some(name) => self.0.insert(channel, name),
            None => self.0.remove(&channel),
        };
    }

    /// All that are named.
    pub fn iter(&self) -> impl Iterator<Item = (Channel, &str)> {
        self.0
            .iter()
            .map(|(channel, name)| (*channel, name.as_str()))
    }

    /// Whether any is named by a number, as the columns of a table without names are.
    pub(super) fn any_number(&self) -> bool {
        self.iter().any(|(_, name)| name.parse::<usize>().is_ok())
    }
}

impl Default for MotorFile {
    fn default() -> Self {
        MotorFile {
            source: None,
            name: None,
            counts_per_rev: None,
            supply_v: None,
            metres_per_rev: None,
            columns: Columns::default(),
            units: Units::default(),
            drive: Drive::Voltage,
            drive_said: false,
            position: None,
            known: Known::default(),
            log: LogPart::default(),
        }
    }
}

impl MotorFile {
    /// Reads a motor file.
    ///
    /// # Errors
    /// The file cannot be read, is not UTF-8 or TOML, or holds a key or value that means nothing.
    pub fn read(path: &Path) -> Result<Self, MotorFileError> {
        let source = path.display().to_string();
        let fail = |fault| MotorFileError::new(Place::file(&source), fault);
        let text = read_text(path).map_err(fail)?;
        MotorFile::parse(&text, &source)
    }

    /// The `motor.toml` in the folder of a recording, `None` where there is none.
    ///
    /// # Errors
    /// There is one and [`read`](Self::read) refuses it.
    pub fn find_beside(recording: &Path) -> Result<Option<Self>, MotorFileError> {
        let path = recording.with_file_name("motor.toml");
        match fs::symlink_metadata(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            _ => MotorFile::read(&path).map(Some),
        }
    }

    /// Encoder counts per revolution: the user's, else those that all logs of the preset have.
    pub fn encoder_counts(&self) -> Option<f64> {
        let usual = self.log.preset.and_then(|preset| preset.counts_per_rev);
        self.counts_per_rev.or(usual)
    }

    /// How messages speak of this file.
    pub(super) fn called(&self) -> &str {
        self.source
            .as_deref()
            .unwrap_or("a `motor.toml` beside the recording")
    }
}

fn read_text(path: &Path) -> Result<String, MotorFault> {
    if path.is_dir() {
        return Err(MotorFault::Folder);
    }
    let file = fs::File::open(path).map_err(MotorFault::Io)?;
    let mut bytes = Vec::new();
    // One byte more than allowed tells too long from just fitting, without reading a large file.
    file.take(MAX_FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(MotorFault::Io)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(MotorFault::TooBig {
            limit: MAX_FILE_BYTES,
        });
    }
    String::from_utf8(bytes).map_err(|_| MotorFault::NotText)
}
