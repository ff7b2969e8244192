//! The first rows of a file that was dropped on the page, and which column may be what.

use serde::{Deserialize, Serialize};
use servoid_io::input;

/// Rows that are shown.
const SHOWN: usize = 6;
/// Most columns that are shown.
const COLUMNS: usize = 200;
/// Most values of a column that are drawn.
const DRAWN: usize = 200;

/// The first rows of a file.
#[derive(Debug, Default, PartialEq, Serialize)]
pub(super) struct Preview {
    /// Names of the columns.
    pub(super) header: Vec<String>,
    /// The first rows.
    pub(super) rows: Vec<Vec<String>>,
    /// Which column may be what.
    pub(super) guess: Mapping,
    /// What separates the columns.
    pub(super) divider: Option<char>,
    /// Values of each column, evenly picked from the rows that were sent; none for what is no number.
    pub(super) values: Vec<Vec<Option<f64>>>,
}

/// Which column is what, and in which unit; empty for what is not there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct Mapping {
    pub(super) time: String,
    pub(super) voltage: String,
    pub(super) angle: String,
    pub(super) current: String,
    pub(super) temperature: String,
    pub(super) enabled: String,
    pub(super) time_unit: String,
    pub(super) voltage_unit: String,
    pub(super) angle_unit: String,
    pub(super) counts_per_rev: Option<f64>,
    pub(super) supply_v: Option<f64>,
    pub(super) resistance_ohm: Option<f64>,
}

/// Looks at the first lines of a file. What is no table of numbers gives no columns; the reader says why.
pub(super) fn preview(csv: &str) -> Preview {
    let mut read = input::preview(csv.as_bytes(), usize::MAX, COLUMNS);
    // The last line may be cut off.
    read.rows.pop();
    let step = read.rows.len().div_ceil(DRAWN).max(1);
    let column = |k: usize| {
        let picked = read.rows.iter().step_by(step);
        picked
            .map(|cells| cells.get(k).and_then(|cell| number(cell)))
            .collect()
    };
    Preview {
        values: (0..read.header.len()).map(column).collect(),
        guess: Mapping::guessed(&read.header),
        rows: read.rows.iter().take(SHOWN).cloned().collect(),
        divider: Some(read.separator).filter(|_| !read.header.is_empty()),
        header: read.header,
    }
}

fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|x: &f64| x.is_finite())
}

impl Mapping {
    /// What the names of a header tell.
    fn guessed(_header: &[String]) -> Self {
        Mapping::default()
    }

    /// As a `motor.toml`.
    pub(super) fn motor(&self) -> String {
        let mut motor = toml::Table::new();
        for (key, value) in [
            ("counts_per_rev", self.counts_per_rev),
            ("supply_v", self.supply_v),
        ] {
            if let Some(value) = value {
                motor.insert(key.to_owned(), value.into());
            }
        }
        let mut insert = |section: &str, pairs: &[(&str, &str)]| {
            let entries: toml::Table = pairs
                .iter()
                .filter(|(_, text)| !text.is_empty())
                .map(|(key, text)| ((*key).to_owned(), (*text).into()))
                .collect();
            if !entries.is_empty() {
                motor.insert(section.to_owned(), entries.into());
            }
        };
        insert(
            "columns",
            &[
                ("time", &self.time),
                ("voltage", &self.voltage),
                ("angle", &self.angle),
                ("current", &self.current),
                ("temperature", &self.temperature),
                ("enabled", &self.enabled),
            ],
        );
        insert(
            "units",
            &[
                ("time", &self.time_unit),
                ("voltage", &self.voltage_unit),
                ("angle", &self.angle_unit),
            ],
        );
        if let Some(ohm) = self.resistance_ohm {
            let mut known = toml::Table::new();
            known.insert("resistance_ohm".to_owned(), ohm.into());
            motor.insert("known".to_owned(), known.into());
        }
        motor.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::input::MotorFile;

    #[test]
    fn a_file_that_was_cut_off_is_guessed_and_drawn() {
        let found = preview("# by hand\nclock_ms\tDuty\tPosition (deg)\n0\t0.5\t1\n1\tx\t2\n2\t0.");
        let Mapping {
            time,
            voltage,
            angle,
            time_unit,
            voltage_unit,
            angle_unit,
            ..
        } = found.guess;
        assert_eq!(
            [time, voltage, angle],
            ["clock_ms", "Duty", "Position (deg)"]
        );
        assert_eq!([time_unit, voltage_unit, angle_unit], ["ms", "duty", "deg"]);
        assert_eq!(found.values[1], [Some(0.5), None]);
        assert_eq!(found.divider, Some('\t'));
    }

    #[test]
    fn a_mapping_is_a_motor_file() {
        let mapping = Mapping {
            time: "zeit".to_owned(),
            angle: "a \"b\"".to_owned(),
            angle_unit: "rad".to_owned(),
            counts_per_rev: Some(2048.0),
            resistance_ohm: Some(1.2),
            ..Mapping::default()
        };
        let motor = MotorFile::parse(&mapping.motor(), "mapping").expect("a motor file");
        assert_eq!(motor.columns.angle.as_deref(), Some("a \"b\""));
        assert_eq!(motor.counts_per_rev, Some(2048.0));
        assert!(motor.known.resistance_ohm.is_some());
    }
}
