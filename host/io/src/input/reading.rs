//! What was read from a file: its recordings, and what its reader has to say of it.

use crate::recording::Recording;

/// The recordings of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// One or more recordings of one motor.
    pub recordings: Vec<Recording>,
    /// What the reader passed over or took for granted, a sentence each, with the file's name.
    pub notes: Vec<String>,
}
