//! A log of any format that the program reads, for the page: what is in it, what its columns may be, and what it holds once that is said.
//! Names of units, drives and presets come from here, so that the page knows none of its own.

use super::loaded::{Loaded, MOTOR, Source};
use crate::error::Error;
use serde::Deserialize;
use serde_json::{Value, json};
use servoid_identify::LateDriver;
use servoid_io::channel::Channel;
use servoid_io::input::{
    AngleUnit, CommandUnit, DriveKind, Envelope, MotorFile, PRESETS, ReadError, Survey,
    SurveyColumn, SurveyTable, TimeUnit, read_as_said, read_recordings, survey,
};
use servoid_io::output::write_csv;
use std::collections::BTreeMap;
use std::path::Path;

/// Rows of a log that are looked at before it is said what it is.
const LOOKED_AT: u64 = 20_000;
/// Tables and columns that are listed.
const TABLES: usize = 200;
const COLUMNS: usize = 400;
/// Points of a small drawing.
const DRAWN: usize = 100;

/// What is said of a log on the page, by the keys of a motor file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default)]
pub(super) struct Asked {
    preset: Option<String>,
    drive: Option<String>,
    table: Option<String>,
    select: Option<String>,
    rate_hz: Option<f64>,
    columns: BTreeMap<String, String>,
    units: BTreeMap<String, String>,
    counts_per_rev: Option<f64>,
    supply_v: Option<f64>,
    metres_per_rev: Option<f64>,
    resistance_ohm: Option<f64>,
    /// A `motor.toml` in the place of all this.
    motor: Option<String>,
}

impl Asked {
    /// As the text of a `motor.toml`.
    pub(super) fn text(&self) -> String {
        if let Some(text) = &self.motor {
            return text.clone();
        }
        let mut motor = toml::Table::new();
        for (key, value) in [
            ("counts_per_rev", self.counts_per_rev),
            ("supply_v", self.supply_v),
            ("metres_per_rev", self.metres_per_rev),
        ] {
            motor.extend(value.map(|value| (key.to_owned(), value.into())));
        }
        let mut section = |name: &str, entries: toml::Table| {
            if !entries.is_empty() {
                motor.insert(name.to_owned(), entries.into());
            }
        };
        let texts = |all: &BTreeMap<String, String>| -> toml::Table {
            let told = all.iter().filter(|(_, text)| !text.is_empty());
            told.map(|(key, text)| (key.clone(), text.clone().into()))
                .collect()
        };
        section("columns", texts(&self.columns));
        section("units", texts(&self.units));
        let text = |key: &str, value: &Option<String>| {
            let told = value.as_ref().filter(|text| !text.is_empty());
            told.map(|text| (key.to_owned(), toml::Value::from(text.clone())))
        };
        section("drive", text("kind", &self.drive).into_iter().collect());
        let log = [
            text("preset", &self.preset),
            text("table", &self.table),
            text("select", &self.select),
            self.rate_hz.map(|rate| ("rate_hz".to_owned(), rate.into())),
        ];
        section("log", log.into_iter().flatten().collect());
        let known = self.resistance_ohm;
        let known = known.map(|ohm| ("resistance_ohm".to_owned(), ohm.into()));
        section("known", known.into_iter().collect());
        motor.to_string()
    }

    /// As a motor file.
    pub(super) fn motor(&self) -> Result<MotorFile, Error> {
        Ok(MotorFile::parse(&self.text(), MOTOR)?)
    }
}

/// What a log holds, in words for the page.
pub(super) struct Looked {
    pub(super) told: Value,
}

impl Looked {
    /// Whether it has a table of which something may be a recording.
    pub(super) fn has_columns(&self) -> bool {
        self.told["proposal"]["columns"]
            .as_object()
            .is_some_and(|all| !all.is_empty())
    }
}

/// Looks at the first rows of a log.
pub(super) fn looked_at(path: &Path, name: &str, asked: &Asked) -> Result<Looked, Error> {
    let motor = asked.motor()?;
    let found = survey(path, &motor, Some(LOOKED_AT), &|_| ());
    let found = found.map_err(|error| called(path, name, error))?;
    let proposal = &found.proposal;
    let kind = proposal.motor.drive_kind();
    let columns: serde_json::Map<String, Value> = (proposal.columns.iter())
        .map(|one| {
            let told = json!({ "column": one.column, "unit": one.unit, "why": one.why });
            (kind.key(one.channel).to_owned(), told)
        })
        .collect();
    let needs: Vec<&str> = proposal
        .needs
        .iter()
        .map(|need| need.text.as_str())
        .collect();
    let log = &proposal.motor.log;
    // The dialog is headed by the file's name.
    let own = format!("{}: ", path.display());
    let notes = found.notes.iter().map(|note| note.replace(&own, ""));
    let told = json!({
        "format": found.format,
        "notes": notes.collect::<Vec<_>>(),
        "tables": found.tables.iter().take(TABLES).map(table).collect::<Vec<_>>(),
        "proposal": {
            "columns": columns,
            "drive": kind.name(),
            "preset": log.preset.map(|preset| preset.name),
            "select": log.select.iter().map(ToString::to_string).collect::<Vec<_>>().join(","),
            "counts_per_rev": proposal.motor.encoder_counts(),
            "supply_v": proposal.motor.supply_v,
            "needs": needs,
            "doubts": proposal.doubts,
        },
        "channels": channels(kind),
        "presets": PRESETS.iter().map(|preset| json!({ "name": preset.name, "about": preset.about })).collect::<Vec<_>>(),
        "drives": [
            { "name": "voltage", "title": "a voltage" },
            { "name": "current", "title": "a current or a torque" },
            { "name": "position", "title": "a target angle" },
        ],
        "first_rows": first_rows(&found),
    });
    Ok(Looked { told })
}

/// An error of a reader, which speaks of the file by its path, with the name by which its owner knows it.
fn called(path: &Path, name: &str, mut error: ReadError) -> Error {
    let own = path.display().to_string();
    error.place.source = error.place.source.replace(&own, name);
    Error::Read(error)
}

/// The channels of a log behind a kind of drive, with the units of each.
fn channels(kind: DriveKind) -> Vec<Value> {
    let angles = || AngleUnit::ALL.iter().map(|(name, _)| *name);
    let speeds = || AngleUnit::SPEEDS.iter().map(|(name, _)| *name);
    let commands = |of_current: bool| -> Vec<&str> {
        let all = CommandUnit::ALL.iter();
        let own = all.filter(|(_, unit)| unit.is_of_current() == of_current);
        own.map(|(name, _)| *name).collect()
    };
    let units = |channel: Channel| -> Vec<&str> {
        match (channel, kind) {
            (Channel::Time, _) => TimeUnit::ALL.iter().map(|(name, _)| *name).collect(),
            (Channel::Command, DriveKind::Position) => angles().collect(),
            (Channel::Command, DriveKind::Current) => commands(true),
            (Channel::Command, DriveKind::Voltage) => commands(false),
            (Channel::Angle, DriveKind::Position) => angles().collect(),
            (Channel::Angle, _) => angles().chain(speeds()).collect(),
            (Channel::Measured(own), _) => own.facts().units.iter().map(|unit| unit.name).collect(),
            (Channel::Enabled | Channel::Direction, _) => Vec::new(),
        }
    };
    let all = Channel::ALL.into_iter();
    all.map(|channel| {
        let facts = channel.facts();
        let title = match (channel, kind) {
            (Channel::Command, DriveKind::Position) => "Target",
            _ => facts.title,
        };
        json!({
            "key": kind.key(channel),
            "title": title,
            "units": units(channel),
            "good_for": facts.good_for,
        })
    })
    .collect()
}

fn table(table: &SurveyTable) -> Value {
    json!({
        "name": table.name,
        "rows": table.rows,
        "columns": table.columns.iter().take(COLUMNS).map(column).collect::<Vec<_>>(),
    })
}

fn column(column: &SurveyColumn) -> Value {
    let ends = column.envelope.as_ref().map(drawn);
    json!({
        "name": column.name,
        "unit": column.unit,
        "is_time": column.is_time,
        "is_number": column.is_number,
        "range": column.profile.range(),
        "drawn": ends,
    })
}

/// A column thinned to what a small drawing shows: the middle of each part.
fn drawn(envelope: &Envelope) -> Vec<Option<f64>> {
    let bins = envelope.bins();
    let step = bins.len().div_ceil(DRAWN).max(1);
    let middle = |bin: &servoid_io::input::Bin| bin.ends().map(|[low, high]| 0.5 * (low + high));
    bins.iter().step_by(step).map(middle).collect()
}

/// The first rows of the table from which most is taken.
fn first_rows(found: &Survey) -> Value {
    const SHOWN: usize = 6;
    let tables = found.tables.iter().rev();
    let best = tables.max_by_key(|table| table.guessed());
    let Some(table) = best else {
        return json!({ "names": [], "rows": [] });
    };
    let columns = || table.columns.iter().take(COLUMNS);
    let names: Vec<&str> = columns().map(|column| column.name.as_str()).collect();
    let rows = (0..SHOWN).map(|k| -> Vec<Option<String>> {
        columns()
            .map(|column| column.profile.first_as_text(k))
            .collect()
    });
    json!({ "names": names, "rows": rows.collect::<Vec<_>>() })
}

/// Reads all recordings of a log as it is said to be, or with a `guess` where nothing is said, each as a text of our own; and what its reader has
/// to say.
pub fn read(
    path: &Path,
    name: &str,
    motor: &MotorFile,
    guess: bool,
) -> Result<(Loaded, Vec<String>), Error> {
    let reading = if guess {
        read_recordings(path, motor)
    } else {
        read_as_said(path, motor, &|_| ())
    };
    let reading = reading.map_err(|error| called(path, name, error))?;
    let own = path.display().to_string();
    let shown = |text: &str| text.replace(&own, name);
    let mut notes: Vec<String> = reading.notes.iter().map(|note| shown(note)).collect();
    let mut sources = Vec::new();
    for recording in &reading.recordings {
        let late = LateDriver::of(recording);
        notes.extend(late.map(|late| shown(&late.remark(recording))));
        let mut csv = Vec::new();
        let written = write_csv(&mut csv, recording, &[]);
        written.map_err(|error| Error::Failed(format!("{name}: {error}")))?;
        sources.push(Source {
            name: shown(&recording.source),
            csv: String::from_utf8_lossy(&csv).into_owned(),
            motor: reading.motor.for_written(recording).to_toml(),
            span_s: late.map(|late| late.span_s(recording)),
        });
    }
    Ok((Loaded::read(sources)?, notes))
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::channel::Measured;

    #[test]
    fn what_is_said_on_the_page_is_a_motor_file() {
        let columns = [("time", "zeit"), ("angle", "a \"b\""), ("current", "")];
        let columns = columns.map(|(key, name)| (key.to_owned(), name.to_owned()));
        let asked = Asked {
            columns: columns.into(),
            units: [("angle".to_owned(), "rad".to_owned())].into(),
            counts_per_rev: Some(2048.0),
            resistance_ohm: Some(1.2),
            ..Asked::default()
        };
        let motor = asked.motor().expect("a motor file");
        assert_eq!(motor.columns.get(Channel::Angle), Some("a \"b\""));
        assert_eq!(
            motor.columns.get(Channel::Measured(Measured::Current)),
            None
        );
        assert_eq!(motor.counts_per_rev, Some(2048.0));
        assert!(motor.known.resistance_ohm.is_some());
    }

    #[test]
    fn every_unit_of_the_page_is_one_of_the_motor_file() {
        for kind in [DriveKind::Voltage, DriveKind::Current, DriveKind::Position] {
            for channel in channels(kind) {
                let key = channel["key"].as_str().expect("a key").to_owned();
                for unit in channel["units"].as_array().expect("units") {
                    let unit = unit.as_str().expect("a unit").to_owned();
                    let asked = Asked {
                        drive: Some(kind.name().to_owned()),
                        units: [(key.clone(), unit.clone())].into(),
                        ..Asked::default()
                    };
                    asked
                        .motor()
                        .unwrap_or_else(|error| panic!("{key} {unit}: {error}"));
                }
            }
        }
    }
}
