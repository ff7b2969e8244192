//! A recording by its file, through the motor file of its source.

use servoid_engine::problem::Data;
use servoid_io::input::{MotorFile, read_recording};
use servoid_io::recording::Recording;
use std::path::Path;
use testing::recordings::{self, Vendored};

/// `path` through the motor file `map`.
pub fn read(path: &Path, map: &str) -> Recording {
    let motor = MotorFile::read(&recordings::map(map)).unwrap_or_else(|error| panic!("{error}"));
    read_recording(path, &motor).unwrap_or_else(|error| panic!("{error}"))
}

/// One of the recordings that are kept here: `file` is such as `qube/qube_00`.
pub fn vendored(file: &str) -> Recording {
    let (source, _) = file.split_once('/').expect("a folder and a name");
    let recordings = Vendored::new();
    read(
        &recordings.unpack(&format!("{file}.csv")),
        &format!("{source}.toml"),
    )
}

/// One of those that are not; none where they are missing.
pub fn elsewhere(file: &str) -> Option<Recording> {
    let (source, _) = file.split_once('/').expect("a folder and a name");
    let path = recordings::elsewhere(&format!("{file}.csv"))?;
    Some(read(&path, &format!("{source}.toml")))
}

pub fn data(recording: &Recording) -> Data {
    Data::new(recording).unwrap_or_else(|error| panic!("{error}"))
}
