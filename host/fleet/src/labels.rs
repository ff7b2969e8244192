//! What is known of recordings beside them: a CSV file that names motor, lot, station, operator and time of each.

use crate::error::{Error, content};
use servoid_batch::Labels;
use std::collections::HashMap;
use std::path::Path;

/// Labels of recordings by their names.
#[derive(Clone, Debug, Default)]
pub struct LabelFile(HashMap<String, Labels>);

impl LabelFile {
    /// Reads a CSV file with a column `unit`, the recording's name as in the results, and any of `serial`, `lot`, `station`,
    /// `operator`, `time`.
    ///
    /// # Errors
    /// A file that cannot be read, has none of these columns, or names a recording twice.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .trim(csv::Trim::All)
            .from_path(path)
            .map_err(content(path))?;
        let head = reader.headers().map_err(content(path))?.clone();
        let column = |name: &str| head.iter().position(|column| column == name);
        let known = ["serial", "lot", "station", "operator", "time"];
        let Some(unit) = column("unit").filter(|_| known.iter().any(|name| column(name).is_some()))
        else {
            return Err(content(path)(format!(
                "needs a column unit, the recording's name, and at least one of {}; it has {}",
                known.join(", "),
                head.iter().collect::<Vec<_>>().join(", ")
            )));
        };
        let mut found = HashMap::new();
        for record in reader.records() {
            let record = record.map_err(content(path))?;
            let cell = |name: &str| {
                let text = column(name).and_then(|at| record.get(at));
                text.filter(|text| !text.is_empty()).map(str::to_owned)
            };
            let labels = Labels {
                serial: cell("serial"),
                lot: cell("lot"),
                station: cell("station"),
                operator: cell("operator"),
                time: cell("time"),
            };
            let name = record.get(unit).unwrap_or_default().to_owned();
            let line = record.position().map_or(0, csv::Position::line);
            if found.insert(name.clone(), labels).is_some() {
                return Err(content(path)(format!(
                    "line {line}: {name} stands there twice"
                )));
            }
        }
        Ok(LabelFile(found))
    }

    /// What is said of a recording.
    pub fn of(&self, unit: &str) -> Option<&Labels> {
        self.0.get(unit)
    }

    /// How many recordings are named.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether none is.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
