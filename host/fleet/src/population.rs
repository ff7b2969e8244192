//! The motors that a fleet is a sample of: means, spreads and correlations of their parameters, with each unit's own uncertainty
//! taken off.

use crate::components::{Interval, Level, covariance, level};
use crate::error::Error;
use crate::quantity::{Quantity, Reading, Scale, Table};
use crate::unit::Unit;
use nalgebra::{DMatrix, SymmetricEigen};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// What a population calls itself.
pub const SCHEMA: &str = "servoid.population/1";
/// Fewer motors are no population.
pub const LEAST: usize = 8;
/// Values that differ by less than this part are one.
const SAME: f64 = 1e-9;

/// `servoid.population/1`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Population {
    /// `servoid.population/1`.
    pub schema: String,
    /// Version of the program.
    pub version: String,
    /// The task of the batch, as JSON.
    pub task: String,
    /// Motors that it is an estimate from.
    pub motors: usize,
    /// Their recordings.
    pub recordings: usize,
    /// Recordings that were left out since they are odd.
    pub odd: usize,
    /// Recordings that were left out since their model has other effects.
    pub other_effects: usize,
    /// The effects of the motors.
    pub effects: Vec<String>,
    /// The parameters that differ.
    pub parameters: Vec<Member>,
    /// Their correlations, each in its scale; a row and a column for each of `parameters`.
    pub correlation: Vec<Vec<f64>>,
    /// Their covariances between motors, in the product of their units.
    pub covariance: Vec<Vec<Bounded>>,
    /// Parameters that all motors have alike.
    #[serde(default)]
    pub fixed: Vec<Fixed>,
    /// Parameters that equal another one in every motor.
    #[serde(default)]
    pub equal: Vec<Equal>,
    /// Phases, which depend on how the encoder sits on the shaft: any angle is as likely.
    #[serde(default)]
    pub phases: Vec<String>,
    /// The result of the motor nearest to the middle: what is drawn are its numbers.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    pub typical: serde_json::Value,
}

/// A value with its interval of 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Bounded {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Bounded {
    fn of(interval: Interval, map: impl Fn(f64) -> f64) -> Self {
        Bounded {
            value: map(interval.value),
            low: map(interval.low),
            high: map(interval.high),
        }
    }
}

/// A parameter of the population.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Member {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The scale in which it is normal.
    pub scale: Scale,
    /// Mean in this scale.
    pub centre: f64,
    /// Standard deviation between motors in this scale.
    pub spread: f64,
    /// Mean over the motors.
    pub mean: Bounded,
    /// Standard deviation between motors.
    pub std: Bounded,
    /// Standard error of one motor's own estimate, in the scale; it is not in the spread.
    pub own_error: f64,
    /// What no motor is below; null where the parameter may have both signs.
    #[serde(default)]
    pub least: Option<f64>,
}

/// A parameter that all motors have alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Fixed {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

/// A parameter that equals another one in every motor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Equal {
    /// Its name.
    pub name: String,
    /// The other.
    pub to: String,
}

/// One quantity over the motors.
struct Column {
    quantity: Quantity,
    readings: Vec<Option<Reading>>,
    level: Level,
}

impl Population {
    /// Of a fleet's motors, without those that are odd. `result` gives a unit's whole result.
    pub(crate) fn of(
        units: &[Unit],
        odd: &[bool],
        (task, version): (&str, &str),
        result: &dyn Fn(usize) -> Result<String, Error>,
    ) -> Result<Self, Error> {
        let mut sets: BTreeMap<&[String], usize> = BTreeMap::new();
        for (unit, _) in units.iter().zip(odd).filter(|(_, odd)| !**odd) {
            *sets.entry(&unit.effects).or_insert(0) += 1;
        }
        let effects = sets.iter().max_by_key(|(_, count)| **count);
        let effects = effects
            .map(|(effects, _)| effects.to_vec())
            .unwrap_or_default();
        let own: Vec<usize> = (0..units.len())
            .filter(|&unit| !odd[unit] && units[unit].effects == effects)
            .collect();
        let members: Vec<Unit> = own.iter().map(|&unit| units[unit].clone()).collect();
        let table = Table::of(&members);
        let motors = by_motor(&members, &table);
        if motors.len() < LEAST || table.quantities.is_empty() {
            return Err(Error::TooLittle(format!(
                "{} motors with the same effects, and {} parameters that their recordings determine: a population needs {LEAST} \
                 motors and a parameter; fit more motors, or the same effects to all (servoid batch --do fit --with ...)",
                motors.len(),
                table.quantities.len()
            )));
        }
        let (columns, fixed, equal) = columns(&table, &motors);
        let (correlation, covariance) = together(&columns);
        let typical = nearest(&members, &table);
        let text = result(own[typical])?;
        let typical: serde_json::Value = serde_json::from_str(&text).map_err(|error| {
            Error::TooLittle(format!("a result of the batch is no JSON: {error}"))
        })?;
        Ok(Population {
            schema: SCHEMA.to_owned(),
            version: version.to_owned(),
            task: task.to_owned(),
            motors: motors.len(),
            recordings: members.len(),
            odd: odd.iter().filter(|odd| **odd).count(),
            other_effects: units.len() - members.len() - odd.iter().filter(|odd| **odd).count(),
            phases: phases(&members),
            effects,
            parameters: columns.iter().map(member).collect(),
            correlation,
            covariance,
            fixed,
            equal,
            typical,
        })
    }

    /// Reads the file that `servoid population --json` wrote.
    ///
    /// # Errors
    /// A file that cannot be read as one.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bad = |why: String| Error::Content {
            path: path.to_owned(),
            why,
        };
        let text = std::fs::read_to_string(path).map_err(|error| bad(error.to_string()))?;
        let found: Population = serde_json::from_str(&text).map_err(|error| {
            bad(format!(
                "is no population: {error}; give what `servoid population RESULTS --json FILE` wrote"
            ))
        })?;
        let width = found.parameters.len();
        let square = found.correlation.len() == width
            && found.correlation.iter().all(|row| row.len() == width);
        let finite = found
            .parameters
            .iter()
            .all(|p| p.centre.is_finite() && p.spread.is_finite() && p.spread >= 0.0)
            && found
                .correlation
                .iter()
                .flatten()
                .all(|r| r.abs() <= 1.0 + SAME);
        if found.schema != SCHEMA || !square || !finite {
            return Err(bad(format!(
                "is no {SCHEMA}: needs finite centres, spreads of at least 0, and a square of correlations between -1 and 1"
            )));
        }
        Ok(found)
    }
}

/// Each motor's readings: the mean of its recordings, whose error is the larger of what each says and of what they differ by.
fn by_motor(units: &[Unit], table: &Table) -> Vec<Vec<Option<Reading>>> {
    let mut motors: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
    for (number, unit) in units.iter().enumerate() {
        motors.entry(unit.motor()).or_default().push(number);
    }
    let mean = |own: &[usize], k: usize| {
        let found: Vec<Reading> = own
            .iter()
            .filter_map(|unit| table.readings[*unit][k])
            .collect();
        let count = found.len() as f64;
        let y = found.iter().map(|reading| reading.y).sum::<f64>() / count;
        let said = found.iter().map(|reading| reading.std.powi(2)).sum::<f64>() / count;
        let apart = found
            .iter()
            .map(|reading| (reading.y - y).powi(2))
            .sum::<f64>();
        let seen = if found.len() > 1 {
            apart / (count - 1.0)
        } else {
            0.0
        };
        (!found.is_empty()).then(|| Reading {
            y,
            std: (said.max(seen) / count).sqrt(),
        })
    };
    let quantities = 0..table.quantities.len();
    let motor = |own: Vec<usize>| quantities.clone().map(|k| mean(&own, k)).collect();
    motors.into_values().map(motor).collect()
}

/// The quantities that differ, with their levels; those that do not, and those that equal another.
fn columns(
    table: &Table,
    motors: &[Vec<Option<Reading>>],
) -> (Vec<Column>, Vec<Fixed>, Vec<Equal>) {
    let (mut columns, mut fixed, mut equal) = (Vec::<Column>::new(), Vec::new(), Vec::new());
    for (k, quantity) in table.quantities.iter().enumerate() {
        let readings: Vec<Option<Reading>> = motors.iter().map(|motor| motor[k]).collect();
        let own: Vec<Reading> = readings.iter().flatten().copied().collect();
        let near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs()).max(SAME);
        let Some(first) = own.first() else { continue };
        if own.iter().all(|reading| near(reading.y, first.y)) {
            fixed.push(Fixed {
                name: quantity.name.clone(),
                value: quantity.scale.raise(first.y),
                unit: quantity.unit.clone(),
            });
            continue;
        }
        let alike = |other: &&Column| {
            let pairs = other.readings.iter().zip(&readings);
            let mut both = pairs.filter_map(|(a, b)| Some(((*a)?, (*b)?)));
            other.quantity.scale == quantity.scale && both.all(|(a, b)| near(a.y, b.y))
        };
        if let Some(other) = columns.iter().find(alike) {
            equal.push(Equal {
                name: quantity.name.clone(),
                to: other.quantity.name.clone(),
            });
            continue;
        }
        let (y, error) = split(&own);
        if let Some(level) = level(&y, &error) {
            columns.push(Column {
                quantity: quantity.clone(),
                readings,
                level,
            });
        }
    }
    (columns, fixed, equal)
}

fn split(readings: &[Reading]) -> (Vec<f64>, Vec<f64>) {
    readings
        .iter()
        .map(|reading| (reading.y, reading.std.powi(2)))
        .unzip()
}

/// Correlations in the scales, and covariances in the units.
fn together(columns: &[Column]) -> (Vec<Vec<f64>>, Vec<Vec<Bounded>>) {
    let width = columns.len();
    let mut correlation = DMatrix::identity(width, width);
    let nothing = Bounded {
        value: 0.0,
        low: 0.0,
        high: 0.0,
    };
    let mut bounded = vec![vec![nothing; width]; width];
    let spread = |column: &Column| column.level.variance.value.sqrt();
    for j in 0..width {
        let own = &columns[j];
        bounded[j][j] = Bounded::of(own.level.variance, |v| to_units(own, own, v));
        for k in 0..j {
            let other = &columns[k];
            let both = own.readings.iter().zip(&other.readings);
            let (a, b): (Vec<Reading>, Vec<Reading>) =
                both.filter_map(|(a, b)| Some(((*a)?, (*b)?))).unzip();
            let ((y, y_error), (z, z_error)) = (split(&a), split(&b));
            let found = covariance((&y, &y_error, &own.level), (&z, &z_error, &other.level));
            let Some(found) = found else { continue };
            let found_units = Bounded::of(found, |c| to_units(own, other, c));
            (bounded[j][k], bounded[k][j]) = (found_units, found_units);
            let product = spread(own) * spread(other);
            if product > 0.0 {
                let r = (found.value / product).clamp(-1.0, 1.0);
                (correlation[(j, k)], correlation[(k, j)]) = (r, r);
            }
        }
    }
    let correlation = possible(correlation);
    let rows = (0..width).map(|j| (0..width).map(|k| correlation[(j, k)]).collect());
    (rows.collect(), bounded)
}

/// The nearest correlations that quantities can have together: pairs were estimated one by one.
fn possible(correlation: DMatrix<f64>) -> DMatrix<f64> {
    let width = correlation.nrows();
    if width == 0 {
        return correlation;
    }
    let mut found = SymmetricEigen::new(correlation);
    found
        .eigenvalues
        .iter_mut()
        .for_each(|value| *value = value.max(0.0));
    let near = found.recompose();
    DMatrix::from_fn(width, width, |j, k| {
        if j == k {
            1.0
        } else {
            near[(j, k)] / (near[(j, j)] * near[(k, k)]).sqrt()
        }
    })
}

/// A covariance in the scales of two quantities as one in their units (of logarithms: of the log-normal distribution).
fn to_units(a: &Column, b: &Column, covariance: f64) -> f64 {
    let mean =
        |column: &Column| mean_in_units(&column.quantity, &column.level, column.level.mean.value);
    match (a.quantity.scale, b.quantity.scale) {
        (Scale::Linear, Scale::Linear) => covariance,
        (Scale::Log, Scale::Log) => mean(a) * mean(b) * libm::expm1(covariance),
        (Scale::Log, Scale::Linear) => mean(a) * covariance,
        (Scale::Linear, Scale::Log) => mean(b) * covariance,
    }
}

fn mean_in_units(quantity: &Quantity, level: &Level, centre: f64) -> f64 {
    match quantity.scale {
        Scale::Linear => centre,
        Scale::Log => libm::exp(centre + 0.5 * level.variance.value),
    }
}

fn member(column: &Column) -> Member {
    let (quantity, level) = (&column.quantity, &column.level);
    let std = |variance: f64| to_units(column, column, variance).max(0.0).sqrt();
    let values = column.readings.iter().flatten().map(|reading| reading.y);
    let least = quantity.scale == Scale::Log || values.fold(f64::INFINITY, f64::min) >= 0.0;
    Member {
        name: quantity.name.clone(),
        unit: quantity.unit.clone(),
        scale: quantity.scale,
        centre: level.mean.value,
        spread: level.variance.value.sqrt(),
        mean: Bounded::of(level.mean, |centre| mean_in_units(quantity, level, centre)),
        std: Bounded::of(level.variance, std),
        own_error: level.error.sqrt(),
        least: least.then_some(0.0),
    }
}

/// The unit whose largest distance from the middle is least.
fn nearest(units: &[Unit], table: &Table) -> usize {
    let mut farthest = vec![0.0_f64; units.len()];
    for k in 0..table.quantities.len() {
        let values: Vec<f64> = table.column(k).map(|(_, reading)| reading.y).collect();
        let (middle, spread) = crate::robust::centre(&values);
        for (unit, far) in farthest.iter_mut().enumerate() {
            let own = table.readings[unit][k].map(|reading| (reading.y - middle).abs());
            if let Some(own) = own.filter(|_| spread > 0.0) {
                *far = far.max(own / spread);
            } else if own.is_none() {
                *far = f64::INFINITY;
            }
        }
    }
    (0..units.len())
        .min_by(|a, b| farthest[*a].total_cmp(&farthest[*b]))
        .unwrap_or(0)
}

/// Parameters that are phases of a wave.
fn phases(units: &[Unit]) -> Vec<String> {
    let parameters = units.first().map_or(&[][..], |unit| &unit.parameters);
    let phases = parameters
        .iter()
        .filter(|found| found.name.ends_with(".phase"));
    phases.map(|found| found.name.clone()).collect()
}
