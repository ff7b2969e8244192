//! What motors of a fleet are compared by: the parameters that most of their recordings determine, each in the scale in which
//! units differ evenly.

use crate::unit::Unit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Part of the recordings that must determine a parameter.
const MOST: f64 = 0.8;
/// Beyond this part of the value a unit's own standard error has no meaning in a logarithm.
const LOG_ERROR: f64 = 0.3;
/// Of the recording and not of the motor, or of where the encoder counts from.
const NOT_OF_THE_MOTOR: [&str; 2] = ["start_speed", "start_offset"];
/// All six, where known facts give them; else what voltage and angle determine.
const PHYSICAL: [&str; 6] = ["resistance", "inductance", "kt", "kb", "inertia", "viscous"];
const RESPONSE: [&str; 4] = ["gain", "a1", "electrical_time_constant", "viscous_part"];

/// The scale in which units differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// The natural logarithm: a positive quantity, whose differences are parts of it.
    Log,
    /// The quantity itself.
    Linear,
}

impl Scale {
    /// A value and its standard error in this scale.
    fn lower(self, value: f64, std: f64) -> (f64, f64) {
        match self {
            Scale::Log => (libm::log(value), std / value),
            Scale::Linear => (value, std),
        }
    }

    /// A value from this scale.
    pub fn raise(self, y: f64) -> f64 {
        match self {
            Scale::Log => libm::exp(y),
            Scale::Linear => y,
        }
    }
}

/// A parameter of the fleet.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The scale in which units differ.
    pub scale: Scale,
}

/// What one recording says of a quantity, in its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Value.
    pub y: f64,
    /// Its standard error.
    pub std: f64,
}

/// The quantities of a fleet, and each unit's readings of them.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// The quantities.
    pub quantities: Vec<Quantity>,
    /// One row a unit, one reading a quantity.
    pub readings: Vec<Vec<Option<Reading>>>,
}

impl Table {
    /// The table of units.
    pub fn of(units: &[Unit]) -> Self {
        let quantities: Vec<Quantity> = names(units)
            .into_iter()
            .map(|(name, unit)| {
                let scale = scale(units, &name);
                Quantity { name, unit, scale }
            })
            .collect();
        let reading = |unit: &Unit, quantity: &Quantity| {
            let found = unit.parameter(&quantity.name)?;
            let (value, std) = (found.value?, found.std?);
            let fits = quantity.scale == Scale::Linear || value > 0.0;
            let (y, std) = fits.then(|| quantity.scale.lower(value, std))?;
            (y.is_finite() && std.is_finite() && found.unit == quantity.unit)
                .then_some(Reading { y, std })
        };
        let row = |unit: &Unit| quantities.iter().map(|q| reading(unit, q)).collect();
        Table {
            readings: units.iter().map(row).collect(),
            quantities,
        }
    }

    /// The readings of quantity `k` with the numbers of their units.
    pub fn column(&self, k: usize) -> impl Iterator<Item = (usize, Reading)> + '_ {
        let rows = self.readings.iter().enumerate();
        rows.filter_map(move |(unit, row)| Some((unit, row[k]?)))
    }
}

/// Names and units of the quantities: what most units determine, once.
fn names(units: &[Unit]) -> Vec<(String, String)> {
    let mut order: Vec<(String, String)> = Vec::new();
    for unit in units {
        for found in &unit.parameters {
            if !order.iter().any(|(name, _)| *name == found.name) {
                order.push((found.name.clone(), found.unit.clone()));
            }
        }
    }
    let determined = |name: &str| {
        let by = units.iter().filter(|unit| {
            unit.parameter(name)
                .is_some_and(|found| found.identifiable && found.std.is_some())
        });
        by.count() as f64 >= MOST * units.len() as f64
    };
    let waves: Vec<String> = order
        .iter()
        .filter_map(|(name, _)| name.strip_suffix(".amplitude").map(str::to_owned))
        .collect();
    let of_a_wave = |name: &str| {
        let (effect, parameter) = name.split_once('.').unwrap_or((name, ""));
        let turns = ["cosine", "sine", "phase"];
        waves.iter().any(|wave| wave == effect)
            && turns.iter().any(|part| parameter.starts_with(part))
    };
    let physical = PHYSICAL.iter().all(|name| determined(name));
    // All six say what the response says, and some of them are no motor.
    let doubled: &[&str] = if physical { &RESPONSE } else { &PHYSICAL };
    let left_out = |name: &str| {
        NOT_OF_THE_MOTOR.contains(&name)
            || doubled.contains(&name)
            // Both turn with the place where the encoder counts from.
            || of_a_wave(name)
    };
    order.retain(|(name, _)| determined(name) && !left_out(name));
    order
}

fn scale(units: &[Unit], name: &str) -> Scale {
    let all = || {
        let found = units.iter().filter_map(|unit| unit.parameter(name));
        found.filter_map(|found| Some((found.value?, found.std?)))
    };
    let positive = all().all(|(value, _)| value > 0.0);
    let sharp = all()
        .filter(|(value, std)| *std < LOG_ERROR * value)
        .count();
    if positive && sharp as f64 >= MOST * all().count() as f64 {
        Scale::Log
    } else {
        Scale::Linear
    }
}
