//! The recordings of a fleet with what a batch found of each.

use crate::error::Error;
use crate::labels::LabelFile;
use servoid_batch::{Labels, Merged, Parameter, Row, runs};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::Path;

/// What a batch found of one recording.
#[derive(Clone, Debug)]
pub struct Unit {
    /// The recording.
    pub name: String,
    /// Which motor it is of, where and when it was made.
    pub labels: Labels,
    /// Verdict of a diagnosis.
    pub verdict: Option<String>,
    /// Effects of its model.
    pub effects: Vec<String>,
    /// RMS error of its model, counts.
    pub rms_counts: Option<f64>,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
}

impl Unit {
    /// The motor that it is of: its serial number, or the recording itself where none is said.
    pub fn motor(&self) -> &str {
        self.labels.serial.as_deref().unwrap_or(&self.name)
    }

    /// The parameter of this name.
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters.iter().find(|found| found.name == name)
    }
}

/// A recording that gave no result.
#[derive(Clone, Debug)]
pub struct Refused {
    /// The recording.
    pub name: String,
    /// The cause, for programs.
    pub cause: String,
    /// The error in words.
    pub message: String,
}

/// All recordings of one task.
#[derive(Clone, Debug, Default)]
pub struct Units {
    /// Those with a result.
    pub found: Vec<Unit>,
    /// Those without.
    pub refused: Vec<Refused>,
    /// The task, as JSON, and the version of servoid that did it.
    pub task: String,
    /// See `task`.
    pub version: String,
    /// Rows of the folder that are of another task or version.
    pub others: usize,
    /// Labels that are of no recording.
    pub unused_labels: usize,
}

/// Reads the results in `folder`: of the last task that a run was asked for, with that run's version.
///
/// # Errors
/// A folder without results, or one that cannot be read.
pub fn read(folder: &Path, labels: Option<&LabelFile>) -> Result<Units, Error> {
    let runs = runs(folder)?;
    let last = runs.last().map(|run| {
        let task = serde_json::to_string(&run.task).unwrap_or_default();
        (task, run.version.clone())
    });
    let mut tasks: BTreeMap<(String, String), usize> = BTreeMap::new();
    for row in Merged::of(folder, false)? {
        let row = row?;
        *tasks.entry((row.task, row.version)).or_insert(0) += 1;
    }
    let total: usize = tasks.values().sum();
    // Folders without a record of runs hold one task, or the one with most rows is meant.
    let most = || {
        let most = tasks.iter().max_by_key(|(_, rows)| **rows);
        most.map(|(task, _)| task.clone())
    };
    let Some((task, version)) = last.filter(|task| tasks.contains_key(task)).or_else(most) else {
        return Err(Error::TooLittle(format!(
            "{}: holds no results; make them with `servoid batch IN --out {0}`",
            folder.display()
        )));
    };
    let mut units = Units {
        others: total - tasks[&(task.clone(), version.clone())],
        task,
        version,
        ..Units::default()
    };
    let mut used = HashSet::new();
    for row in Merged::of(folder, false)? {
        let row = row?;
        if row.task != units.task || row.version != units.version {
            continue;
        }
        let said = labels.and_then(|labels| labels.of(&row.unit));
        if said.is_some() {
            used.insert(row.unit.clone());
        }
        if row.is_ok() {
            units.found.push(unit(row, said));
        } else {
            units.refused.push(Refused {
                name: row.unit,
                cause: row.cause.unwrap_or_default(),
                message: row.message.unwrap_or_default(),
            });
        }
    }
    units.unused_labels = labels.map_or(0, |labels| labels.len() - used.len());
    Ok(units)
}

/// The rows of these recordings with their whole results.
///
/// # Errors
/// A folder that cannot be read.
pub(crate) fn results(
    folder: &Path,
    units: &Units,
    wanted: impl Fn(&str) -> bool,
) -> Result<HashMap<String, String>, Error> {
    let mut found = HashMap::new();
    for row in Merged::of(folder, true)? {
        let row = row?;
        let ours = row.task == units.task && row.version == units.version;
        if let (true, true, Some(result)) = (ours, wanted(&row.unit), row.result) {
            found.insert(row.unit, result);
        }
    }
    Ok(found)
}

fn unit(row: Row, said: Option<&Labels>) -> Unit {
    let own = row.labels.unwrap_or_default();
    let mut labels = said.map_or(own.clone(), |said| Labels {
        serial: said.serial.clone().or(own.serial),
        lot: said.lot.clone().or(own.lot),
        station: said.station.clone().or(own.station),
        operator: said.operator.clone().or(own.operator),
        time: said.time.clone().or(own.time),
    });
    // A folder of a folder of logs is a lot, unless somebody says otherwise.
    if labels.lot.is_none() {
        let folder = row
            .unit
            .split_once('/')
            .map(|(folder, _)| folder.to_owned());
        labels.lot = folder;
    }
    Unit {
        name: row.unit,
        labels,
        verdict: row.verdict,
        effects: row.effects,
        rms_counts: row.rms_counts,
        parameters: row.parameters,
    }
}
