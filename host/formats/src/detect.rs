//! Which format a file has, told by its first bytes.

use crate::error::FormatError;
use crate::hdf5;
use crate::json;
use crate::lerobot::{self, LeRobot};
use crate::log::Log;
use crate::matlab;
use crate::mcap::{self, Mcap};
use crate::numpy;
use crate::parquet::{self, Parquet};
use crate::wpilog::{self, Wpilog};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Bytes of a file by which its format is told.
const HEAD: u64 = 4096;

/// Formats that are read here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Parquet.
    Parquet,
    /// A folder with a dataset of LeRobot.
    LeRobot,
    /// MCAP.
    Mcap,
    /// A data log of WPILib.
    Wpilog,
    /// An array of NumPy.
    Npy,
    /// Arrays of NumPy in a zip archive.
    Npz,
    /// MATLAB, level 5.
    Matlab5,
    /// HDF5, or MATLAB version 7.3.
    Hdf5,
    /// One value of JSON.
    Json,
    /// JSON, a value a line.
    JsonLines,
    /// JSON of WPILib's SysId.
    SysId,
}

impl Format {
    /// Its name for messages.
    pub fn name(self) -> &'static str {
        match self {
            Format::Parquet => "Parquet file",
            Format::LeRobot => "LeRobot dataset",
            Format::Mcap => "MCAP file",
            Format::Wpilog => "WPILib data log",
            Format::Npy => "NumPy array",
            Format::Npz => "NumPy archive",
            Format::Matlab5 => "MATLAB file",
            Format::Hdf5 => "HDF5 file",
            Format::Json => "JSON document",
            Format::JsonLines => "file of JSON lines",
            Format::SysId => "SysId file",
        }
    }

    /// The format of a file that begins with `head`; `None` for what is none of them, a text with columns among it.
    pub fn of(head: &[u8]) -> Option<Self> {
        if head.starts_with(parquet::MAGIC) {
            return Some(Format::Parquet);
        }
        if head.starts_with(mcap::MAGIC) {
            return Some(Format::Mcap);
        }
        if head.starts_with(wpilog::MAGIC) {
            return Some(Format::Wpilog);
        }
        if head.starts_with(numpy::MAGIC) {
            return Some(Format::Npy);
        }
        if numpy::is_archive(head) {
            return Some(Format::Npz);
        }
        if hdf5::is_hdf5(head) {
            return Some(Format::Hdf5);
        }
        if matlab::is_level5(head) {
            return Some(Format::Matlab5);
        }
        json::format_of(head)
    }
}

/// Opens a log; `None` where the file is of no format that is read here (it may be a text with columns).
///
/// # Errors
/// The file cannot be read, or is of a format that it contradicts.
pub fn open(path: &Path) -> Result<Option<Box<dyn Log>>, FormatError> {
    if path.is_dir() {
        if !lerobot::is_dataset(path) {
            return Ok(None);
        }
        return Ok(Some(Box::new(LeRobot::open(path)?)));
    }
    let source = path.display().to_string();
    let fail = |error| FormatError::new(&source, "", error);
    let mut head = Vec::new();
    let file = File::open(path).map_err(fail)?;
    file.take(HEAD).read_to_end(&mut head).map_err(fail)?;
    match Format::of(&head) {
        None => Ok(None),
        Some(Format::Parquet) => Ok(Some(Box::new(Parquet::open(path)?))),
        Some(Format::Mcap) => Ok(Some(Box::new(Mcap::open(path)?))),
        Some(Format::Wpilog) => Ok(Some(Box::new(Wpilog::open(path)?))),
        Some(Format::Npy) => numpy::open_npy(path).map(Some),
        Some(Format::Npz) => numpy::open_npz(path).map(Some),
        Some(Format::Matlab5) => matlab::open_level5(path).map(Some),
        Some(Format::Hdf5) => hdf5::open(path, &head).map(Some),
        Some(Format::Json | Format::SysId) => json::open_document(path).map(Some),
        Some(Format::JsonLines) => json::open_lines(path).map(Some),
        Some(Format::LeRobot) => Ok(None),
    }
}
