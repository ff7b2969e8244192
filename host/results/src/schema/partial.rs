//! The keys that other verbs need of a result, each optional: files of older versions lack some, and what is missing is
//! said by its name.

use super::diagnosis::Alternative;
use super::{Estimate, Model, device};
use serde::Deserialize;
use serde::de::IgnoredAny;

/// A diagnosis, as far as a plan follows from it.
#[derive(Deserialize)]
pub(super) struct Alike {
    pub schema: Option<String>,
    pub models: Option<Vec<Alternative>>,
    pub supply_v: Option<f64>,
    pub no_load_rad_s: Option<f64>,
    pub counts_per_rev: Option<f64>,
    pub sample_s: Option<f64>,
}

/// Any result that holds a model, as far as an export follows from it.
#[derive(Deserialize)]
pub(super) struct Partial {
    pub recording: Option<String>,
    pub drive: Option<String>,
    pub supply_v: Option<f64>,
    pub counts_per_rev: Option<f64>,
    pub sample_s: Option<f64>,
    /// Of a fit.
    pub parameters: Option<Vec<Estimate>>,
    /// Of a fit.
    pub converged: Option<bool>,
    /// Of a fit.
    pub model: Option<Model>,
    /// Of a diagnosis.
    #[serde(rename = "final")]
    pub last: Option<Found>,
    /// Of the diagnosis of a curve of steady speeds.
    pub steady: Option<IgnoredAny>,
    /// Of a verification.
    pub diagnosis: Option<Box<Partial>>,
    /// Of a device's report.
    pub period_us: Option<f64>,
    /// Of a device's report.
    pub outcome: Option<Outcome>,
    /// Of a device's report.
    pub failure: Option<Failed>,
    /// Of a device's report.
    pub grade: Option<device::Grade>,
    /// Of a device's report.
    pub reason: Option<String>,
}

/// Why a device gave up.
#[derive(Deserialize)]
pub(super) struct Failed {
    pub message: String,
}

/// A model and its numbers, which a diagnosis has under `final` and a fit at the top. (Flattened into both, errors would
/// lose their line.)
#[derive(Deserialize)]
pub(super) struct Found {
    pub parameters: Option<Vec<Estimate>>,
    pub converged: Option<bool>,
    pub model: Option<Model>,
}

/// What a device found, as far as a model follows from it.
#[derive(Deserialize)]
pub(super) struct Outcome {
    pub parameters: Vec<device::Parameter>,
    pub converged: bool,
}
