//! One row of a Parquet file of recordings: lists for the series, and what is known of the motor.

use crate::row::Labels;
use serde::{Deserialize, Serialize};
use servoid_io::channel::Measured;
use servoid_io::input::{Arrays, MotorFile, MotorFileError, ReadError, recording_of};
use servoid_io::recording::Recording;

/// A recording as a row: the contract's columns, each a list.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Columns {
    /// Its name; its number in the file if it has none.
    #[serde(default)]
    pub(crate) unit: Option<String>,
    pub(crate) t_s: Vec<f64>,
    pub(crate) voltage_v: Vec<f64>,
    pub(crate) angle_counts: Vec<f64>,
    #[serde(default)]
    pub(crate) current_a: Option<Vec<f64>>,
    #[serde(default)]
    pub(crate) temperature_c: Option<Vec<f64>>,
    #[serde(default)]
    pub(crate) enabled: Option<Vec<bool>>,
    #[serde(default)]
    pub(crate) counts_per_rev: Option<f64>,
    #[serde(default)]
    pub(crate) supply_v: Option<f64>,
    /// What is known of the motor, as the text of a `motor.toml`.
    #[serde(default)]
    pub(crate) motor: Option<String>,
    #[serde(default)]
    pub(crate) serial: Option<String>,
    #[serde(default)]
    pub(crate) lot: Option<String>,
    #[serde(default)]
    pub(crate) station: Option<String>,
    #[serde(default)]
    pub(crate) operator: Option<String>,
    #[serde(default)]
    pub(crate) time: Option<String>,
}

impl Columns {
    /// All that is numbers, for a digest.
    pub(crate) fn numbers(&self) -> Vec<Vec<f64>> {
        let enabled = self.enabled.iter().flatten();
        vec![
            self.t_s.clone(),
            self.voltage_v.clone(),
            self.angle_counts.clone(),
            self.current_a.clone().unwrap_or_default(),
            self.temperature_c.clone().unwrap_or_default(),
            enabled.map(|on| f64::from(u8::from(*on))).collect(),
            self.counts_per_rev.into_iter().collect(),
            self.supply_v.into_iter().collect(),
        ]
    }

    /// Which motor it is of, where and when it was made; none where nothing is said.
    pub(crate) fn labels(&self) -> Option<Labels> {
        let labels = Labels {
            serial: self.serial.clone(),
            lot: self.lot.clone(),
            station: self.station.clone(),
            operator: self.operator.clone(),
            time: self.time.clone(),
        };
        (!labels.is_empty()).then_some(labels)
    }

    /// What is known of the motor, as text.
    pub(crate) fn motor_text(&self) -> &str {
        self.motor.as_deref().unwrap_or_default()
    }

    /// What is known of the motor.
    pub(crate) fn motor(&self) -> Result<MotorFile, MotorFileError> {
        let mut motor = MotorFile::parse(self.motor_text(), "the column motor")?;
        motor.counts_per_rev = self.counts_per_rev.or(motor.counts_per_rev);
        motor.supply_v = self.supply_v.or(motor.supply_v);
        Ok(motor)
    }

    /// The recording, called `name`.
    pub(crate) fn recording(&self, name: &str, motor: &MotorFile) -> Result<Recording, ReadError> {
        let told = [
            (Measured::Current, &self.current_a),
            (Measured::Temperature, &self.temperature_c),
        ];
        let told = told.into_iter();
        let measured: Vec<_> = told
            .filter_map(|(channel, values)| Some((channel, values.as_deref()?)))
            .collect();
        let arrays = Arrays {
            time: &self.t_s,
            command: &self.voltage_v,
            angle: &self.angle_counts,
            measured: &measured,
            enabled: self.enabled.as_deref(),
        };
        recording_of(&arrays, name, motor)
    }
}
