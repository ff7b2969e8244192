//! `servoid.fit/1`, of `fit`, and of `demo` with its truth and its diagnosis.

use super::certificate::Certificate;
use super::diagnosis::Diagnosis;
use super::estimate::{Estimate, Identifiable, Margins};
use super::lack_of_fit::LackOfFit;
use super::likelihood::Likelihood;
use super::profile::Profile;
use super::read::Read;
use super::{Model, PositionLoop, RecordingError, VERSION, finite};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Data;
use servoid_identify::fit;
use servoid_identify::truth::ParameterError;
use shared::encoder::FLOOR_RMS_COUNTS;

/// What a fit calls itself.
pub const SCHEMA: &str = "servoid.fit/1";

/// `servoid.fit/1`: a model fitted to a recording.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Fit {
    /// `servoid.fit/1`.
    #[serde(default)]
    pub schema: String,
    /// Search method.
    pub algorithm: String,
    /// Seed of the search.
    pub seed: u64,
    /// Model evaluations that it took.
    pub evaluations: usize,
    /// Least cost.
    pub cost: f64,
    /// Name of the cost: `squared`, `iae`, `iae_floored`, `interval`.
    pub cost_kind: String,
    /// RMS of model minus reading over the whole recording, open loop, counts.
    pub rms_counts: f64,
    /// The same on the recording of `--validate`, never fitted.
    pub validate_rms_counts: Option<f64>,
    /// RMS of the encoder's own error, 1/√12 counts.
    pub quantization_floor_counts: Option<f64>,
    /// Free runs of windows, each started from the measured state.
    pub windowed: Option<Windowed>,
    /// Part of the drive that is unexplained along the measured motion.
    pub equation_error_relative: Option<f64>,
    /// Effects beside the linear motor.
    pub effects: Vec<String>,
    /// Parameters with their errors.
    pub parameters: Vec<Estimate>,
    /// What voltage and angle determine.
    #[serde(default)]
    pub identifiable: Identifiable,
    /// Margins of the position loop.
    pub margins: Option<Margins>,
    /// Whether the search ended near a minimum; if not, no `std` is given.
    pub converged: bool,
    /// Samples that are worth as much as independent ones.
    pub effective_samples: Option<f64>,
    /// What a user should know.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Errors as the effects of `--with` are added one by one; empty without effects.
    #[serde(default)]
    pub ladder: Vec<Addition>,
    /// The model with all its numbers, which runs again.
    pub model: Model,
    /// The fitted recording.
    pub recording: String,
    /// The recording of `--validate`.
    pub validate: Option<String>,
    /// The error on each recording, where there are several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub recordings: Vec<RecordingError>,
    /// What the command drives: `voltage` or `current`.
    #[serde(default)]
    pub drive: String,
    /// The position loop behind each recording of target angles; absent where there is none. `drive` is then what the motor
    /// gets, `voltage`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub position_loops: Vec<PositionLoop>,
    /// Supply, V.
    pub supply_v: Option<f64>,
    /// Encoder counts per revolution.
    pub counts_per_rev: Option<f64>,
    /// Sample interval, s.
    pub sample_s: Option<f64>,
    /// How the log was read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub read: Option<Read>,
    /// Whether the user stopped the search.
    #[serde(default)]
    pub interrupted: bool,
    /// The fit with process noise; absent where the free run is at the encoder's floor or the equations do not apply.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<Likelihood>,
    /// What repeats of a command say of the model; absent where no command was recorded twice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lack_of_fit: Option<LackOfFit>,
    /// What is certain of the readings and this model (`fit --certificate`); absent where nobody asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// The profile likelihood of each parameter (`fit --profile`); absent where nobody asked.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub profiles: Vec<Profile>,
    /// Noise before the counter, standard deviation, counts (`--cost interval`): what model and encoder leave unexplained. Absent
    /// with other costs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_counts: Option<f64>,
    /// Its standard error, counts; absent where it stands at the least that is followed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sigma_std_counts: Option<f64>,
    /// The unknowns of the search with their covariance; absent where they have none, and of results without it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joint: Option<Joint>,
    /// Version of the program.
    #[serde(default)]
    pub version: String,
}

/// Unknowns that the data determine, as the search has them: torques in volts at the winding, no physical parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Joint {
    /// Their names.
    pub names: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// Their values.
    pub values: Vec<f64>,
    /// A row and a column for each, in the product of their units.
    pub covariance: Vec<Vec<f64>>,
}

impl From<&fit::Joint> for Joint {
    fn from(joint: &fit::Joint) -> Self {
        Joint {
            names: joint.names.clone(),
            units: joint.units.iter().map(|&unit| unit.to_owned()).collect(),
            values: joint.values.clone(),
            covariance: joint.covariance.clone(),
        }
    }
}

/// Errors of free runs in windows.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Windowed {
    /// Length of a window, s.
    pub window_s: Option<f64>,
    /// RMS error, counts.
    pub rms_counts: Option<f64>,
    /// RMS error as a part of the motion's.
    pub relative: Option<f64>,
}

/// Errors of a model to which one effect more was added.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Addition {
    /// The effect that was added last; null for the linear motor.
    pub added: Option<String>,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
}

/// `servoid.fit/1` of the last model of `demo`, with the diagnosis and the truth beside it.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Demo {
    /// The last model.
    #[serde(flatten)]
    pub fit: Fit,
    /// What the bench hides.
    pub hidden: Option<String>,
    /// Whether the diagnosis found it.
    #[serde(default)]
    pub named: bool,
    /// How far off its parameters are, which only a bench can tell.
    #[serde(default)]
    pub parameter_errors: Vec<Miss>,
    /// Error of the gain, per cent.
    pub gain_error_percent: Option<f64>,
    /// Error of `a1`, per cent.
    pub a1_error_percent: Option<f64>,
    /// The diagnosis, `servoid.diagnosis/1`.
    pub diagnosis: Option<Box<Diagnosis>>,
}

/// How far off a parameter is from the truth.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Miss {
    /// The effect.
    pub effect: String,
    /// Its parameter.
    pub parameter: String,
    /// Whether it is the effect's size; else it is its shape.
    #[serde(default)]
    pub size: bool,
    /// Distance from the truth, per cent of the truth.
    pub percent: f64,
}

impl From<ParameterError> for Miss {
    fn from(error: ParameterError) -> Self {
        Miss {
            effect: error.effect,
            parameter: error.parameter,
            size: error.size,
            percent: error.percent,
        }
    }
}

impl Fit {
    /// From a fit of `data`, judged also on the recording called `validate`.
    pub fn new(fit: &fit::Fit, data: &Data, validate: Option<&str>) -> Self {
        Fit {
            schema: SCHEMA.to_owned(),
            algorithm: fit.algorithm.clone(),
            seed: fit.seed,
            evaluations: fit.evaluations,
            cost: fit.cost,
            cost_kind: fit.cost_kind.to_owned(),
            rms_counts: fit.rms_counts,
            validate_rms_counts: fit.validate_rms_counts,
            quantization_floor_counts: Some(FLOOR_RMS_COUNTS),
            windowed: fit.windowed.map(|w| Windowed {
                window_s: finite(w.window_s),
                rms_counts: finite(w.rms_counts),
                relative: finite(w.relative),
            }),
            equation_error_relative: fit.equation_error,
            effects: fit.effects.iter().map(|&name| name.to_owned()).collect(),
            parameters: fit.parameters.iter().map(Estimate::from).collect(),
            identifiable: fit.response.into(),
            margins: fit.margins.map(Margins::from),
            converged: fit.converged,
            effective_samples: finite(fit.effective_samples),
            notes: fit.notes.clone(),
            ladder: (fit.error_ladder.iter())
                .map(|entry| Addition {
                    added: entry.added.map(str::to_owned),
                    rms_counts: finite(entry.rms_counts),
                    validate_rms_counts: entry.validate_rms_counts.and_then(finite),
                })
                .collect(),
            model: Model::of(&fit.candidate, fit.method).driven_by(data.drive),
            recording: data.source.clone(),
            validate: validate.map(str::to_owned),
            recordings: fit.recordings.iter().map(Into::into).collect(),
            drive: data.drive.name().to_owned(),
            position_loops: PositionLoop::all(data),
            supply_v: finite(data.supply),
            counts_per_rev: finite(data.units.counts_per_rev),
            sample_s: finite(data.units.interval),
            read: None,
            interrupted: fit.interrupted,
            likelihood: fit.likelihood.as_ref().map(Likelihood::from),
            lack_of_fit: fit.lack_of_fit.map(Into::into),
            certificate: fit.certificate.as_ref().map(Certificate::from),
            profiles: fit.profiles.iter().map(Profile::from).collect(),
            sigma_counts: fit.reading_noise.map(|noise| noise.counts),
            sigma_std_counts: fit.reading_noise.and_then(|noise| noise.std),
            joint: fit.joint.as_ref().map(Joint::from),
            version: VERSION.to_owned(),
        }
    }
}
