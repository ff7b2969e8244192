//! The first rows of a file that was dropped on the page, and which column may be what.

use serde::{Deserialize, Serialize};

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
    pub(super) enabled: String,
    pub(super) time_unit: String,
    pub(super) voltage_unit: String,
    pub(super) angle_unit: String,
    pub(super) counts_per_rev: Option<f64>,
    pub(super) supply_v: Option<f64>,
    pub(super) resistance_ohm: Option<f64>,
}

/// Words by which a column is known, the likeliest first.
const WORDS: [(&str, &[&str]); 5] = [
    ("time", &["t_s", "time", "timestamp", "t", "sec"]),
    (
        "voltage",
        &["voltage", "volt", "duty", "pwm", "command", "cmd", "u", "v"],
    ),
    (
        "angle",
        &[
            "angle", "count", "encoder", "position", "enc", "pos", "theta", "q",
        ],
    ),
    ("current", &["current", "amp", "i_a"]),
    ("enabled", &["enabled", "enable"]),
];

/// Units that a column's name may end in.
const UNITS: [(&str, &[&str]); 3] = [
    ("time", &["s", "ms", "us"]),
    ("voltage", &["V", "duty"]),
    ("angle", &["counts", "deg", "rad", "rev"]),
];

/// Looks at the first lines of a file. What is no table of numbers gives no columns; the reader says why.
pub(super) fn preview(csv: &str) -> Preview {
    let mut lines = csv.lines().filter(|line| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    });
    let Some(first) = lines.next() else {
        return Preview::default();
    };
    let divider = [',', ';', '\t']
        .into_iter()
        .max_by_key(|c| first.matches(*c).count())
        .unwrap_or(',');
    let cells = |line: &str| -> Vec<String> {
        let cells = line.split(divider).take(COLUMNS);
        cells
            .map(|cell| cell.trim().trim_matches('"').to_owned())
            .collect()
    };
    let header = cells(first);
    let lines: Vec<&str> = lines.collect();
    let rows = lines.iter().take(SHOWN).map(|line| cells(line)).collect();
    // The last line may be cut off.
    let whole = &lines[..lines.len().saturating_sub(1)];
    let picked = whole.iter().step_by(whole.len().div_ceil(DRAWN).max(1));
    let mut values = vec![Vec::new(); header.len()];
    for line in picked {
        let cells = cells(line);
        for (k, values) in values.iter_mut().enumerate() {
            values.push(cells.get(k).and_then(|cell| number(cell, divider)));
        }
    }
    let guess = guess(&header);
    Preview {
        header,
        rows,
        guess,
        divider: Some(divider),
        values,
    }
}

/// A number, which has a decimal comma where commas do not separate.
fn number(cell: &str, divider: char) -> Option<f64> {
    let text = if divider == ',' {
        cell.to_owned()
    } else {
        cell.replace(',', ".")
    };
    text.parse().ok().filter(|x: &f64| x.is_finite())
}

fn guess(header: &[String]) -> Mapping {
    let mut free: Vec<&String> = header.iter().collect();
    let mut found = Vec::new();
    for (what, words) in WORDS {
        let place = words.iter().find_map(|word| {
            free.iter()
                .position(|name| is_called(&name.to_lowercase(), word))
        });
        found.push((what, place.map(|place| free.remove(place).clone())));
    }
    let name = |what: &str| {
        let found = found.iter().find(|(own, _)| *own == what);
        found.and_then(|(_, name)| name.clone()).unwrap_or_default()
    };
    let unit = |what: &str| {
        let name = name(what).to_lowercase();
        let last = name.rsplit(['_', ' ', '[', '(']).next().unwrap_or_default();
        let last = last.trim_end_matches([']', ')']).to_owned();
        let units = UNITS.iter().find(|(own, _)| *own == what);
        let units = units.map_or(&[] as &[&str], |(_, units)| units);
        let unit = units.iter().find(|unit| unit.to_lowercase() == last);
        (*unit.or(units.first()).unwrap_or(&"")).to_owned()
    };
    Mapping {
        time_unit: unit("time"),
        voltage_unit: unit("voltage"),
        angle_unit: unit("angle"),
        time: name("time"),
        voltage: name("voltage"),
        angle: name("angle"),
        current: name("current"),
        enabled: name("enabled"),
        ..Mapping::default()
    }
}

/// A short word must be the whole name or a part between marks, a long one may stand anywhere in it.
fn is_called(name: &str, word: &str) -> bool {
    if word.len() > 3 {
        return name.contains(word);
    }
    name == word || name.split(['_', ' ', '[', '(', '.']).next() == Some(word)
}

impl Mapping {
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
    fn columns_are_guessed_from_names_that_people_use() {
        for (header, time, voltage, angle, unit) in [
            (
                "t_s,voltage_v,angle_counts",
                "t_s",
                "voltage_v",
                "angle_counts",
                "counts",
            ),
            ("time;u;theta_rad", "time", "u", "theta_rad", "rad"),
            (
                "Timestamp [ms]\tDuty\tPosition (deg)",
                "Timestamp [ms]",
                "Duty",
                "Position (deg)",
                "deg",
            ),
            ("t,qm,vir", "t", "", "", "counts"),
        ] {
            let Preview { guess, .. } = preview(&format!("# made by hand\n\n{header}\n1,2,3\n"));
            assert_eq!(
                [&guess.time, &guess.voltage, &guess.angle, &guess.angle_unit],
                [time, voltage, angle, unit],
                "{header}"
            );
        }
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

    #[test]
    fn whatever_is_dropped_gives_a_preview() {
        for text in [
            "",
            "\n\n",
            "#",
            "\u{0}\u{1}",
            ",,,,",
            "{\"a\": 1}",
            &"x,".repeat(5000),
        ] {
            let preview = preview(text);
            assert!(preview.header.len() <= COLUMNS && preview.rows.len() <= SHOWN);
        }
    }
}
