//! A recording as it came, and as it is fitted.

use crate::diagnose::holdout;
use crate::error::Error;
use crate::input::{Known, MotorFile, read_recording_from};
use crate::problem::Data;
use crate::recording::Recording;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A file and what is known of it: all that is needed to read it again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// Its text.
    pub csv: String,
    /// A `motor.toml`.
    #[serde(default)]
    pub motor: String,
}

/// A recording on the bench.
pub struct Loaded {
    /// As it came.
    pub source: Source,
    /// Read.
    pub recording: Recording,
    /// As it is fitted.
    pub data: Arc<Data>,
    /// Facts about the motor.
    pub known: Known,
}

impl Loaded {
    /// Reads a recording.
    ///
    /// # Errors
    /// What the reader of recordings and of motor files refuse, in their words.
    pub fn read(source: Source) -> Result<Self, Error> {
        let motor = MotorFile::parse(&source.motor, "what is said of the motor")?;
        let recording = read_recording_from(source.csv.as_bytes(), &source.name, &motor)?;
        recording.check_excited()?;
        Ok(Loaded {
            data: Arc::new(Data::new(&recording)?),
            known: motor.known,
            recording,
            source,
        })
    }

    /// The part to fit and the end to hold out, where there is no second recording. `None` where it is too short.
    pub fn cut(&self) -> Option<(Data, Data, f64)> {
        let (first, rest, kind) = holdout::cut(&self.recording)?;
        let holdout::HeldOut::End { from_s, .. } = kind else {
            return None;
        };
        let rest = Data::new(&rest).ok()?;
        let rest = rest.at_end_of(Arc::clone(&self.data));
        Some((Data::new(&first).ok()?, rest, from_s))
    }
}
