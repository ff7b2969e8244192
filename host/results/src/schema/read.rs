//! How a log was read: what its columns were taken as, and what its reader has to say.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_io::input::MotorFile;
use std::collections::BTreeMap;

/// How a log was read. Columns and units that are not named here are the contract's own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Read {
    /// Names of columns by what they were taken as, as under `[columns]` of a motor file.
    pub columns: BTreeMap<String, String>,
    /// Their units, as under `[units]`.
    pub units: BTreeMap<String, String>,
    /// What the reader skipped, repaired or took for granted, a sentence each.
    pub remarks: Vec<String>,
}

impl Read {
    /// What was read with a motor file.
    pub fn of(motor: &MotorFile, remarks: Vec<String>) -> Self {
        let written: toml::Table = motor.to_toml().parse().unwrap_or_default();
        let texts = |section: &str| -> BTreeMap<String, String> {
            let entries = written.get(section).and_then(toml::Value::as_table);
            let told = entries.into_iter().flatten();
            told.filter_map(|(key, value)| Some((key.clone(), value.as_str()?.to_owned())))
                .collect()
        };
        Read {
            columns: texts("columns"),
            units: texts("units"),
            remarks,
        }
    }
}
