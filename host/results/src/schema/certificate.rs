//! What is certain of a recording and a model.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::certificate;

/// What is certain of the readings and a model: whether one reproduces all, and which parameters it may have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Certificate {
    /// Whether a model meets every reading.
    pub feasible: bool,
    /// Number of readings.
    pub readings: usize,
    /// How many of them the best model reproduces.
    pub reproduced: usize,
    /// Distance of the best model from the nearest edge of any cell, counts. Below zero it is the least by which every model
    /// near the fit misses some reading.
    pub room_counts: f64,
    /// How far each unknown may go; empty where no model meets all readings.
    pub bounds: Vec<ParameterBounds>,
    /// By how much the readings are not linear in the parameters over these bounds, counts; the bounds have room for it.
    pub nonlinearity_counts: Option<f64>,
    /// By how much the readings change when the model's step is halved, counts; the bounds have room for it.
    pub integration_counts: Option<f64>,
    /// The fewest readings that no model near the fit meets together; empty where one meets all.
    pub contradiction: Vec<Contradicting>,
}

/// Beyond these a model contradicts a reading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ParameterBounds {
    /// Name, as among the parameters.
    pub name: String,
    /// Unit symbol.
    pub unit: String,
    /// Least value; null where the search range ends before the readings say so.
    pub low: Option<f64>,
    /// Greatest value, likewise.
    pub high: Option<f64>,
}

/// A reading that contradicts others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Contradicting {
    /// Number of the sample, from zero.
    pub sample: usize,
    /// Its time, s.
    pub time_s: f64,
    /// The reading, counts.
    pub counts: f64,
    /// Whether models that meet the others lie above its cell; else below.
    pub above: bool,
}

impl From<&certificate::Certificate> for Certificate {
    fn from(found: &certificate::Certificate) -> Self {
        let bounds = found.bounds.iter().map(|bounds| ParameterBounds {
            name: bounds.name.clone(),
            unit: bounds.unit.to_owned(),
            low: bounds.low.and_then(finite),
            high: bounds.high.and_then(finite),
        });
        let contradiction = found.contradiction.iter().map(|reading| Contradicting {
            sample: reading.sample,
            time_s: reading.time_s,
            counts: reading.counts,
            above: reading.above,
        });
        Certificate {
            feasible: found.is_feasible(),
            readings: found.readings,
            reproduced: found.reproduced,
            room_counts: found.room_counts,
            bounds: bounds.collect(),
            nonlinearity_counts: finite(found.nonlinearity_counts),
            integration_counts: finite(found.integration_counts),
            contradiction: contradiction.collect(),
        }
    }
}
