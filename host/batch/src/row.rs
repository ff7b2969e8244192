//! One row of the table: what came of one recording.

use serde::{Deserialize, Serialize};

/// What came of one recording, or why nothing did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Digest of name, content, task, version and seed.
    pub key: String,
    /// The recording: its path beneath the folder, or its name in the file.
    pub unit: String,
    /// The motor's name, if its owner gave one.
    pub motor: Option<String>,
    /// Which motor it is of, where and when it was made; what a Parquet file of recordings says of each.
    #[serde(default)]
    pub labels: Option<Labels>,
    /// `ok` or `error`.
    pub status: String,
    /// The cause of an error, for programs.
    pub cause: Option<String>,
    /// The error in words.
    pub message: Option<String>,
    /// `fit` or `diagnose`.
    pub verb: String,
    /// The task with all its options, as JSON.
    pub task: String,
    /// The version of servoid.
    pub version: String,
    /// Verdict of a diagnosis.
    pub verdict: Option<String>,
    /// Effects of the last model.
    pub effects: Vec<String>,
    /// RMS error of the last model on what was fitted, counts.
    pub rms_counts: Option<f64>,
    /// The same on what was held out, counts.
    pub validate_rms_counts: Option<f64>,
    /// Parameters of the last model.
    pub parameters: Vec<Parameter>,
    /// The whole result as JSON: `servoid.fit/1` or `servoid.diagnosis/1`.
    #[serde(default)]
    pub result: Option<String>,
}

/// Which motor a recording is of, and where, when and by whom it was made.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Labels {
    /// The motor's serial number: recordings with the same one are of one motor.
    pub serial: Option<String>,
    /// The lot that the motor was made in.
    pub lot: Option<String>,
    /// The test station that recorded it.
    pub station: Option<String>,
    /// Who recorded it.
    pub operator: Option<String>,
    /// When it was recorded, ISO 8601.
    pub time: Option<String>,
}

impl Labels {
    /// Each with its name.
    pub fn named(&self) -> [(&'static str, Option<&str>); 5] {
        [
            ("serial", self.serial.as_deref()),
            ("lot", self.lot.as_deref()),
            ("station", self.station.as_deref()),
            ("operator", self.operator.as_deref()),
            ("time", self.time.as_deref()),
        ]
    }

    /// Whether nothing is said.
    pub fn is_empty(&self) -> bool {
        self.named().iter().all(|(_, said)| said.is_none())
    }
}

/// A parameter of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value; none where it is not determined.
    pub value: Option<f64>,
    /// Its standard error; none where it is not determined.
    pub std: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Whether the recording, with what is known of the motor, determines it.
    #[serde(default)]
    pub identifiable: bool,
}

impl Row {
    /// Where it stands in a table.
    pub(crate) fn place(&self) -> (String, String) {
        (self.unit.clone(), self.key.clone())
    }

    /// Whether there is a result.
    pub fn is_ok(&self) -> bool {
        self.status == OK
    }
}

/// The status of a row with a result, and of one without.
pub(crate) const OK: &str = "ok";
pub(crate) const ERROR: &str = "error";
