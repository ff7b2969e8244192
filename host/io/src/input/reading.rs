//! What was read from a file: its recordings, and what its reader has to say of it.

use super::motor_file::MotorFile;
use crate::recording::Recording;

/// The recordings of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// One or more recordings of one motor.
    pub recordings: Vec<Recording>,
    /// What the reader passed over or took for granted, a sentence each, with the file's name.
    pub notes: Vec<String>,
    /// What is known of the motor and its log: what was said, and what was taken where nothing was.
    pub motor: MotorFile,
}

impl Reading {
    pub(super) fn of(recordings: Vec<Recording>, notes: Vec<String>) -> Self {
        Reading {
            recordings,
            notes,
            motor: MotorFile::default(),
        }
    }
}
