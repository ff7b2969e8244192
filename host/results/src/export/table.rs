//! Every number with its unit, its error, its side, and whether it is determined: what toml, json and csv write.

use super::subject::Subject;
use super::written::Written;
use schemars::JsonSchema;
use serde::Serialize;

/// One row.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Row {
    /// Name.
    pub name: String,
    /// The number; none where it is not determined.
    pub value: Option<f64>,
    /// Its unit.
    pub unit: String,
    /// Standard deviation.
    pub std: Option<f64>,
    /// Whether the data determine it.
    pub identifiable: bool,
    /// Which shaft it speaks of.
    pub side: &'static str,
}

/// All rows.
pub fn rows(subject: &Subject, written: &mut Written) -> Vec<Row> {
    let mut rows = Vec::new();
    for value in &subject.values {
        let unit = subject.unit_shown(&value.unit);
        if value.determined {
            written.map(&value.name, &value.name, &unit);
        } else {
            written.lacks(&value.name, "not determined by this recording");
        }
        rows.push(Row {
            name: value.name.clone(),
            value: value.determined.then_some(value.value),
            unit,
            std: value.std,
            identifiable: value.determined,
            side: subject.side.name(),
        });
    }
    rows
}
