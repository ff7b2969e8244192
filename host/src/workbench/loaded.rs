//! A recording as it came, and as it is fitted.

use crate::error::Error;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{HeldOut, holdout};
use servoid_io::input::{Known, MotorFile, read_recording_from};
use servoid_io::recording::Recording;
use std::sync::{Arc, OnceLock};

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

/// What messages call the motor file, whether it was a file or fields of the page.
pub(super) const MOTOR: &str = "what is said of the motor";

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
    cut: OnceLock<Option<Cut>>,
}

/// A recording in two parts, where there is no other one to judge by.
pub struct Cut {
    /// The part to fit.
    pub fitted: Data,
    /// The end to hold out.
    pub held_out: Data,
    /// Where that begins, s.
    pub from_s: f64,
    /// The same in the words of a diagnosis.
    pub kind: HeldOut,
}

impl Loaded {
    /// Reads a recording.
    ///
    /// # Errors
    /// What the reader of recordings and of motor files refuse, in their words.
    pub fn read(source: Source) -> Result<Self, Error> {
        let motor = MotorFile::parse(&source.motor, MOTOR)?;
        let recording = read_recording_from(source.csv.as_bytes(), &source.name, &motor)?;
        recording.check_excited()?;
        Ok(Loaded {
            data: Arc::new(Data::new(&recording)?),
            known: motor.known,
            recording,
            source,
            cut: OnceLock::new(),
        })
    }

    /// Whether it holds the same samples: then it tests nothing that was fitted to the other.
    pub fn is_copy_of(&self, other: &Loaded) -> bool {
        self.recording.is_copy_of(&other.recording)
    }

    /// The part to fit and the end to hold out, made when they are first asked for. `None` where it is too short.
    pub fn cut(&self) -> Option<&Cut> {
        self.cut.get_or_init(|| self.cut_now()).as_ref()
    }

    fn cut_now(&self) -> Option<Cut> {
        let (first, rest, kind) = holdout::cut(&self.recording)?;
        let HeldOut::End { from_s, .. } = kind else {
            return None;
        };
        Some(Cut {
            fitted: Data::new(&first).ok()?,
            held_out: Data::new(&rest).ok()?.at_end_of(Arc::clone(&self.data)),
            from_s,
            kind,
        })
    }
}
