//! `servoid.fleet/1`: what all recordings of a batch say together.

use crate::drift::{Drift, drifts};
use crate::error::Error;
use crate::gauge::{Gauge, gauges};
use crate::group::{Difference, Group, differences, groups};
use crate::labels::LabelFile;
use crate::odd::{Odd, odd};
use crate::population::Population;
use crate::quantity::{Scale, Table};
use crate::robust::{centre, quantile};
use crate::unit::{Unit, Units, read, results};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

/// What a fleet calls itself.
pub const SCHEMA: &str = "servoid.fleet/1";

/// `servoid.fleet/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Summary {
    /// `servoid.fleet/1`.
    pub schema: String,
    /// Version of servoid that did the batch.
    pub version: String,
    /// The batch's task, as JSON.
    pub task: String,
    /// The folder of results.
    pub results: String,
    /// Recordings with a result.
    pub recordings: usize,
    /// Their motors: recordings with one serial number are of one.
    pub motors: usize,
    /// Rows of the folder that are of another task or version, and do not count.
    pub other_rows: usize,
    /// Labels that are of no recording.
    pub unused_labels: usize,
    /// Recordings without a result, by the cause.
    pub refused: Vec<Cause>,
    /// How many recordings have each set of effects.
    pub effects: Vec<Effects>,
    /// What motors are compared by.
    pub quantities: Vec<Spread>,
    /// The recordings that are not like the others, the oddest first.
    pub odd: Vec<Odd>,
    /// By lot.
    pub lots: Vec<Group>,
    /// How lots differ.
    pub lot_differences: Vec<Difference>,
    /// By station.
    pub stations: Vec<Group>,
    /// How stations differ.
    pub station_differences: Vec<Difference>,
    /// Changes with time.
    pub drifts: Vec<Drift>,
    /// Repeatability and reproducibility.
    pub gauges: Vec<Gauge>,
}

/// A cause of refusals.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Cause {
    /// The cause.
    pub cause: String,
    /// Recordings.
    pub recordings: usize,
    /// One of them.
    pub example: String,
    /// What was said of it.
    pub message: String,
}

/// A set of effects.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Effects {
    /// The effects.
    pub effects: Vec<String>,
    /// Recordings whose model has these and no others.
    pub recordings: usize,
}

/// A quantity over the recordings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Spread {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The scale in which motors differ evenly.
    pub scale: Scale,
    /// Recordings that tell it.
    pub recordings: usize,
    /// The middle one of its values.
    pub median: f64,
    /// 2.5 of 100 are below.
    pub low: f64,
    /// 2.5 of 100 are above.
    pub high: f64,
    /// Robust standard deviation, in the scale.
    pub spread: f64,
}

/// A fleet: all recordings of a batch.
#[derive(Clone, Debug)]
pub struct Fleet {
    folder: PathBuf,
    units: Units,
    table: Table,
    odd: Vec<(usize, Odd)>,
}

impl Fleet {
    /// Reads the results in a folder.
    ///
    /// # Errors
    /// A folder without results, or one that cannot be read.
    pub fn read(folder: &Path, labels: Option<&LabelFile>) -> Result<Self, Error> {
        let units = read(folder, labels)?;
        let table = Table::of(&units.found);
        let whole = |wanted: &BTreeSet<usize>| -> HashMap<usize, String> {
            let names: HashMap<&str, usize> = wanted
                .iter()
                .map(|unit| (units.found[*unit].name.as_str(), *unit))
                .collect();
            // A part that is damaged since it was read: then nothing more is said of these.
            let found = results(folder, &units, |name| names.contains_key(name));
            let found = found.unwrap_or_default().into_iter();
            found
                .filter_map(|(name, text)| Some((*names.get(name.as_str())?, text)))
                .collect()
        };
        let odd = odd(&units.found, &table, &whole);
        Ok(Fleet {
            folder: folder.to_owned(),
            table,
            odd,
            units,
        })
    }

    /// The recordings with a result.
    pub fn units(&self) -> &[Unit] {
        &self.units.found
    }

    pub(crate) fn table(&self) -> &Table {
        &self.table
    }

    /// Whether each recording is odd.
    pub(crate) fn is_odd(&self) -> Vec<bool> {
        let mut is_odd = vec![false; self.units.found.len()];
        for (unit, _) in &self.odd {
            is_odd[*unit] = true;
        }
        is_odd
    }

    /// Whether a recording is odd by this parameter.
    pub(crate) fn is_odd_by(&self, unit: usize, quantity: &str) -> bool {
        let odd = self.odd.iter().find(|(odd, _)| *odd == unit);
        odd.is_some_and(|(_, odd)| {
            let mut reasons = odd.reasons.iter();
            reasons.any(|reason| reason.name.as_deref() == Some(quantity))
        })
    }

    /// The whole result of a recording, as JSON.
    ///
    /// # Errors
    /// A recording that is not there, or has no result.
    pub fn result(&self, name: &str) -> Result<String, Error> {
        if let Some(refused) = self
            .units
            .refused
            .iter()
            .find(|refused| refused.name == name)
        {
            return Err(Error::TooLittle(format!(
                "{name}: gave no result: {}",
                refused.message
            )));
        }
        let found = results(&self.folder, &self.units, |unit| unit == name)?;
        let known = self.units.found.iter().take(3);
        let known: Vec<&str> = known.map(|unit| unit.name.as_str()).collect();
        found.into_values().next().ok_or_else(|| {
            Error::Usage(format!(
                "--unit {name}: there is no such recording; there are {}, ...",
                known.join(", ")
            ))
        })
    }

    /// The whole results of the recordings that are odd, at most so many, in the order in which the summary names them.
    ///
    /// # Errors
    /// A folder that cannot be read any more.
    pub(crate) fn odd_results(&self, most: usize) -> Result<Vec<(String, String)>, Error> {
        let listed = self.odd.iter().take(most);
        let names: Vec<&str> = listed.map(|(_, odd)| odd.unit.as_str()).collect();
        let wanted: HashSet<&str> = names.iter().copied().collect();
        let mut found = results(&self.folder, &self.units, |unit| wanted.contains(unit))?;
        let each = names.into_iter();
        Ok(each.filter_map(|name| found.remove_entry(name)).collect())
    }

    /// The population of its motors.
    ///
    /// # Errors
    /// Too few motors.
    pub fn population(&self) -> Result<Population, Error> {
        let units = &self.units;
        let result = |unit: usize| self.result(&units.found[unit].name);
        Population::of(
            &units.found,
            &self.is_odd(),
            (&units.task, &units.version),
            &result,
        )
    }

    /// What all recordings say together.
    pub fn summary(&self) -> Summary {
        let (units, table) = (&self.units.found, &self.table);
        let is_odd = self.is_odd();
        let motors: BTreeSet<&str> = units.iter().map(Unit::motor).collect();
        let lots = groups(units, table, |unit| unit.labels.lot.as_deref());
        let stations = groups(units, table, |unit| unit.labels.station.as_deref());
        Summary {
            schema: SCHEMA.to_owned(),
            version: self.units.version.clone(),
            task: self.units.task.clone(),
            results: self.folder.display().to_string(),
            recordings: units.len(),
            motors: motors.len(),
            other_rows: self.units.others,
            unused_labels: self.units.unused_labels,
            refused: causes(&self.units),
            effects: sets(units),
            quantities: spreads(table),
            odd: self.odd.iter().map(|(_, odd)| odd.clone()).collect(),
            lot_differences: differences(units, table, &is_odd, |u| u.labels.lot.as_deref()),
            station_differences: differences(units, table, &is_odd, |u| {
                u.labels.station.as_deref()
            }),
            drifts: drifts(units, table, &is_odd),
            gauges: gauges(units, table, &is_odd),
            lots,
            stations,
        }
    }
}

fn causes(units: &Units) -> Vec<Cause> {
    let mut causes: BTreeMap<&str, Cause> = BTreeMap::new();
    for refused in &units.refused {
        let cause = causes.entry(&refused.cause).or_insert_with(|| Cause {
            cause: refused.cause.clone(),
            recordings: 0,
            example: refused.name.clone(),
            message: refused.message.clone(),
        });
        cause.recordings += 1;
    }
    let mut causes: Vec<Cause> = causes.into_values().collect();
    causes.sort_by_key(|cause| std::cmp::Reverse(cause.recordings));
    causes
}

fn sets(units: &[Unit]) -> Vec<Effects> {
    let mut sets: BTreeMap<&[String], usize> = BTreeMap::new();
    for unit in units {
        *sets.entry(&unit.effects).or_insert(0) += 1;
    }
    let mut sets: Vec<Effects> = sets
        .into_iter()
        .map(|(effects, recordings)| Effects {
            effects: effects.to_vec(),
            recordings,
        })
        .collect();
    sets.sort_by_key(|set| std::cmp::Reverse(set.recordings));
    sets
}

fn spreads(table: &Table) -> Vec<Spread> {
    let spread = |k: usize| {
        let quantity = &table.quantities[k];
        let values: Vec<f64> = table.column(k).map(|(_, reading)| reading.y).collect();
        let at = |part: f64| quantity.scale.raise(quantile(&values, part));
        Spread {
            name: quantity.name.clone(),
            unit: quantity.unit.clone(),
            scale: quantity.scale,
            recordings: values.len(),
            median: at(0.5),
            low: at(0.025),
            high: at(0.975),
            spread: centre(&values).1,
        }
    };
    (0..table.quantities.len()).map(spread).collect()
}
