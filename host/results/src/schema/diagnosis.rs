//! `servoid.diagnosis/1` of two recordings.

use super::estimate::{Estimate, Identifiable, Margins};
use super::lack_of_fit::LackOfFit;
use super::likelihood::{Bounded, Likelihood};
use super::model::in_terms_of;
use super::read::Read;
use super::residual::{Residual, Where};
use super::{Machine, Model, ModelParameter, PositionLoop, RecordingError, finite};
use crate::schema::effect_curve::EffectCurve;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::diagnose;
use servoid_identify::diagnose::FittedModel;
use servoid_identify::discovery::Proposed;
use servoid_identify::fit;
use servoid_io::recording::Drive;

/// RMS errors of the last model in windows and over whole runs, counts.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Prediction {
    /// Length of the windows, each run from the measured state, s.
    pub window_s: f64,
    /// In windows of the fitted recording.
    pub windowed_rms_counts: f64,
    /// Over the whole fitted recording, from the best start angle.
    pub whole_rms_counts: f64,
    /// In windows of what was held out.
    pub validate_windowed_rms_counts: f64,
    /// Over the whole of what was held out.
    pub validate_whole_rms_counts: f64,
}

impl From<diagnose::Prediction> for Prediction {
    fn from(prediction: diagnose::Prediction) -> Self {
        Prediction {
            window_s: prediction.window_s,
            windowed_rms_counts: prediction.windowed,
            whole_rms_counts: prediction.whole,
            validate_windowed_rms_counts: prediction.held_out_windowed,
            validate_whole_rms_counts: prediction.held_out_whole,
        }
    }
}

/// What a diagnosis calls itself.
pub const SCHEMA: &str = "servoid.diagnosis/1";

/// `servoid.diagnosis/1`: where the model fails, and which effects are missing.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Diagnosis {
    /// `servoid.diagnosis/1`.
    #[serde(default)]
    pub schema: String,
    /// RMS of the encoder's own error, 1/√12 counts.
    pub quantization_floor_counts: Option<f64>,
    /// The linear motor.
    pub base: Base,
    /// `complete`, `missing_effects`, `unexplained` or `inconclusive`.
    pub verdict: String,
    /// The verdict in two sentences.
    #[serde(default)]
    pub summary: String,
    /// The effects in the order in which they were added.
    pub steps: Vec<Step>,
    /// The model with all of them, fitted to its end.
    #[serde(rename = "final")]
    pub last: Final,
    /// The effect that would reduce the error most and was not believed.
    pub not_named: Option<String>,
    /// What to do next.
    #[serde(default)]
    pub advice: Vec<String>,
    /// The command that plans the recording which separates the look-alikes.
    pub next_command: Option<String>,
    /// What these recordings cannot tell, whatever the verdict.
    #[serde(default)]
    pub cannot_tell: Vec<String>,
    /// The fault of the recordings by which any model must fail.
    pub cause: Option<String>,
    /// What to know about the recordings before believing anything.
    #[serde(default)]
    pub remarks: Vec<String>,
    /// Laws that were proposed for what the catalogue leaves; absent where they were not looked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub proposed: Option<Vec<ProposedLaw>>,
    /// Where models fail.
    #[serde(default)]
    pub residual: Residual,
    /// What was held out.
    pub held_out: HeldOut,
    /// Length of the windows that models were judged in, s; null where whole runs were.
    pub window_s: Option<f64>,
    /// Why windows.
    pub window_reason: Option<String>,
    /// The best linear motor with Coulomb friction, offset and delay, or some of them; absent where the last model reaches the
    /// encoder's floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<Baseline>,
    /// Intensity of the process noise that the last model leaves, referred to the winding; absent with `likelihood`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub process_noise: Option<Bounded>,
    /// The fit with process noise; absent where the last model reaches the encoder's floor, and where the diagnosis was judged in windows:
    /// there the parameters have their standard errors from the score.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub likelihood: Option<Likelihood>,
    /// Sets of effects that may be what is missing: the last model's, then the others by their probability. What they leave to
    /// one is "none of these".
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hypotheses: Vec<Hypothesis>,
    /// What stands below the last model's error; absent where nothing is known of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<Floor>,
    /// Part of what is explainable of the linear motor's error that the last model explains, as squares over the span in which models
    /// were judged, 0 to 1; absent with `floor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explained_share: Option<f64>,
    /// What repeats of a command say of the last model; absent where no command was recorded twice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lack_of_fit: Option<LackOfFit>,
    /// Part of the fitted motion's variance that the last model explains in one run over the whole recording, per cent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explained_percent: Option<f64>,
    /// What the last model predicts; absent where it reaches the encoder's floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prediction: Option<Prediction>,
    /// The chosen model and one for each look-alike.
    #[serde(default)]
    pub models: Vec<Alternative>,
    /// Supply, V.
    pub supply_v: Option<f64>,
    /// Fastest speed of the linear motor on its supply, or the fastest seen, rad/s.
    pub no_load_rad_s: Option<f64>,
    /// Encoder counts per revolution.
    pub counts_per_rev: Option<f64>,
    /// Sample interval, s.
    pub sample_s: Option<f64>,
    /// The fitted recording.
    pub recording: String,
    /// The error of the last model on each recording, where there are several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub recordings: Vec<RecordingError>,
    /// What the command drives: `voltage` or `current`.
    #[serde(default)]
    pub drive: String,
    /// The position loop behind each recording of target angles; absent where there is none. `drive` is then what the motor
    /// gets, `voltage`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub position_loops: Vec<PositionLoop>,
    /// Seed of everything random.
    pub seed: u64,
    /// How the log was read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub read: Option<Read>,
    /// Whether the user stopped the work.
    #[serde(default)]
    pub interrupted: bool,
    /// Whether the work ran out before all was tried.
    #[serde(default)]
    pub ran_out: bool,
    /// Steps of a model that it took.
    #[serde(default)]
    pub model_steps: u64,
    /// Version of the program.
    #[serde(default)]
    pub version: String,
}

/// The linear motor with Coulomb friction, offset and delay, or some of them.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Baseline {
    /// Which of them.
    pub effects: Vec<String>,
    /// Over the whole fitted recording, counts RMS.
    pub rms_counts: Option<f64>,
    /// Over the whole of what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// The same, and in windows.
    pub prediction: Prediction,
}

impl From<&diagnose::Baseline> for Baseline {
    fn from(baseline: &diagnose::Baseline) -> Self {
        let names = baseline.effects.iter().map(|kind| kind.name().to_owned());
        Baseline {
            effects: names.collect(),
            rms_counts: finite(baseline.prediction.whole),
            validate_rms_counts: finite(baseline.prediction.held_out_whole),
            prediction: baseline.prediction.into(),
        }
    }
}

/// What a right model would still miss the fitted recordings by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Floor {
    /// `encoder`, `repeatability` (what repeats of a command differ by; without repeats, where nothing is left that the command and the
    /// motion foretell), or `unknown`.
    pub kind: String,
    /// RMS error, counts; of an `unknown` floor what the motor's repeatability would be if nothing were missing.
    pub counts: Option<f64>,
    /// Length of the windows over which it holds, s; null where whole runs were judged.
    pub window_s: Option<f64>,
    /// What tells it: `repeats` of a command or an observer's `innovations`; absent where it is the encoder's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<String>,
    /// Part of an observer's innovations that its own prediction foretells; absent where there are too few readings in motion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foretold_share: Option<f64>,
    /// From what most of it is foretold, as `speed` or `angle`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub foretold_from: Option<String>,
}

impl From<&diagnose::Floor> for Floor {
    fn from(floor: &diagnose::Floor) -> Self {
        Floor {
            kind: floor.kind.name().to_owned(),
            counts: finite(floor.counts),
            window_s: floor.window_s.and_then(finite),
            from: floor.told_by().map(str::to_owned),
            foretold_share: floor.foretold.and_then(|foretold| finite(foretold.share)),
            foretold_from: (floor.foretold).and_then(|foretold| foretold.from.map(str::to_owned)),
        }
    }
}

/// A set of effects that may be what is missing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Hypothesis {
    /// The effects; empty for the linear motor alone.
    pub effects: Vec<String>,
    /// Its probability.
    pub probability: f64,
    /// Logarithm of its likelihood less the price of its parameters, nats; only differences mean anything. Absent where the sets were
    /// judged by their errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nats: Option<f64>,
}

impl From<&diagnose::ProbableSet> for Hypothesis {
    fn from(set: &diagnose::ProbableSet) -> Self {
        Hypothesis {
            effects: set
                .effects
                .iter()
                .map(|kind| kind.name().to_owned())
                .collect(),
            probability: set.probability,
            nats: set.nats.and_then(finite),
        }
    }
}

/// The linear motor of a diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Base {
    /// Always empty.
    #[serde(default)]
    pub effects: Vec<String>,
    /// The model with all its numbers.
    pub model: Model,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// Errors in windows, each run from the measured state, where whole runs say little.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub windowed: Option<Errors>,
}

/// Errors of a model.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Errors {
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
}

/// One effect that was added.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Step {
    /// The effect.
    pub added: String,
    /// Effects that explain the data as well.
    #[serde(default)]
    pub indistinguishable_from: Vec<String>,
    /// Those of them that only refine it: they can do what it does, and the data do not ask for more.
    #[serde(default)]
    pub refined_by: Vec<String>,
    /// From one half (no lead over the best rival that is no look-alike) to one.
    pub confidence: Option<f64>,
    /// Of the refit with it, on what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// Of the refit with it, on what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// What was foreseen before the refit, counts RMS.
    pub foreseen_rms_counts: Option<f64>,
    /// Errors that are soon forgotten, where free runs are chaotic and models are judged by these instead.
    pub tracked: Option<Errors>,
    /// How long these are remembered, s.
    pub tracked_memory_s: Option<f64>,
    /// Part of the recording, from its begin, over which a chaotic free run keeps to the readings.
    pub followed: Option<f64>,
    /// Errors in windows, each run from the measured state, where whole runs say little.
    pub windowed: Option<Errors>,
    /// What was measured that speaks for it.
    #[serde(default)]
    pub evidence: String,
    /// The refit with it; counts that were lost are not put back in it.
    pub model: Option<Model>,
    /// Where the recording asks for the effect: what the model with it misses without it, its other constants kept.
    #[serde(rename = "where")]
    pub whereabouts: Option<Where>,
    /// The effect in the last model beside a curve that was found without its form; absent where no variable alone carries it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<EffectCurve>,
    /// Everything that was tried, best first.
    #[serde(default)]
    pub candidates: Vec<Candidate>,
}

/// One effect that was tried.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Candidate {
    /// The effect.
    pub effect: String,
    /// All effects of the model with it.
    #[serde(default)]
    pub effects: Vec<String>,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// What was foreseen before the refit, counts RMS.
    pub foreseen_rms_counts: Option<f64>,
    /// As in a step.
    pub tracked: Option<Errors>,
    /// As in a step.
    pub windowed: Option<Errors>,
    /// Chance of so large a gain if the effect were absent.
    pub p_value: Option<f64>,
    /// Model evaluations of its refit.
    #[serde(default)]
    pub evaluations: usize,
}

/// The last model of a diagnosis, fitted to its end.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Final {
    /// Its effects.
    pub effects: Vec<String>,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// Parameters with their errors.
    pub parameters: Vec<Estimate>,
    /// Whether its fit came to its end.
    pub converged: bool,
    /// What a user should know.
    #[serde(default)]
    pub notes: Vec<String>,
    /// The model with all its numbers.
    pub model: Model,
    /// What voltage and angle determine.
    #[serde(default)]
    pub identifiable: Identifiable,
    /// Margins of the position loop.
    pub margins: Option<Margins>,
}

/// What was held out.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct HeldOut {
    /// `recording`, `end` (of the fitted one, cut at `from_s`) or `nothing` (the same recording twice).
    pub kind: String,
    /// The other recording.
    pub source: Option<String>,
    /// Where the held-out end begins, s.
    pub from_s: Option<f64>,
    /// How long it is, s.
    pub seconds: Option<f64>,
    /// Whether the motor rests where it begins.
    pub at_rest: Option<bool>,
}

/// A model that explains the recording; torques and inertia referred to the winding.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Alternative {
    /// Its effects.
    pub effects: Vec<String>,
    /// Laws among them that are none of the catalogue, as they were stated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub formulas: Vec<String>,
    /// `chosen` or `alternative`.
    #[serde(default)]
    pub role: String,
    /// The linear machine.
    pub machine: Machine,
    /// The effects' parameters, torques in V.
    #[serde(default)]
    pub parameters: Vec<ModelParameter>,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
}

/// A law that was proposed for what the catalogue leaves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ProposedLaw {
    /// Its name as an effect.
    pub name: String,
    /// Its text, as `--effect` takes it.
    pub law: String,
    /// Share of the missing volts on what was held out that it explains along the measured motion.
    pub explained_percent: Option<f64>,
    /// The effect of the catalogue that gives most alike; absent where none does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resembles: Option<Resembles>,
    /// Whether it was named after simulation, by the rules of every effect.
    pub named: bool,
}

/// An effect that is like a law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Resembles {
    /// The effect.
    pub effect: String,
    /// Square of the correlation of what both give along the fitted recording, per cent.
    pub percent: Option<f64>,
}

impl Diagnosis {
    /// Writes the units of all models in terms of the command of a drive.
    pub(crate) fn in_terms_of(&mut self, drive: Drive) {
        let steps = self.steps.iter_mut().filter_map(|step| step.model.as_mut());
        let models = [&mut self.base.model, &mut self.last.model]
            .into_iter()
            .chain(steps);
        let all = models.map(|model| &mut model.parameters);
        let roles = self.models.iter_mut().map(|one| &mut one.parameters);
        all.chain(roles)
            .for_each(|parameters| in_terms_of(drive, parameters));
    }
}

impl From<&Proposed> for ProposedLaw {
    fn from(law: &Proposed) -> Self {
        ProposedLaw {
            name: law.name.clone(),
            law: law.text.clone(),
            explained_percent: finite(100.0 * law.explained),
            resembles: law.resembles.map(|(kind, part)| Resembles {
                effect: kind.name().to_owned(),
                percent: finite(100.0 * part),
            }),
            named: law.named,
        }
    }
}

impl From<&FittedModel> for Base {
    fn from(refit: &FittedModel) -> Self {
        Base {
            effects: Vec::new(),
            model: Model::of(&refit.candidate, refit.method),
            rms_counts: finite(refit.rms_counts),
            validate_rms_counts: finite(refit.validate_rms_counts),
            windowed: refit.windowed.map(Errors::from),
        }
    }
}

impl From<diagnose::Errors> for Errors {
    fn from(errors: diagnose::Errors) -> Self {
        Errors {
            rms_counts: finite(errors.fitted),
            validate_rms_counts: finite(errors.held_out),
        }
    }
}

impl Candidate {
    /// A refit of a step, with the chance of its gain.
    pub fn new(refit: &FittedModel, p_value: f64) -> Self {
        let effects = effects(refit);
        Candidate {
            effect: effects.last().cloned().unwrap_or_default(),
            effects,
            rms_counts: finite(refit.rms_counts),
            validate_rms_counts: finite(refit.validate_rms_counts),
            foreseen_rms_counts: finite(refit.predicted_rms_counts),
            tracked: refit.observed.map(|t| t.errors.into()),
            windowed: refit.windowed.map(Errors::from),
            p_value: finite(p_value),
            evaluations: refit.evaluations,
        }
    }
}

impl Final {
    /// From the fit of the last model and its errors on both recordings, counts RMS.
    pub fn new(fit: &fit::Fit, effects: Vec<String>, (fitted, held_out): (f64, f64)) -> Self {
        Final {
            effects,
            rms_counts: finite(fitted),
            validate_rms_counts: finite(held_out),
            parameters: fit.parameters.iter().map(Into::into).collect(),
            converged: fit.converged,
            notes: fit.notes.clone(),
            model: Model::of(&fit.candidate, fit.method),
            identifiable: fit.response.into(),
            margins: fit.margins.map(Margins::from),
        }
    }
}

impl From<&diagnose::HeldOut> for HeldOut {
    fn from(held_out: &diagnose::HeldOut) -> Self {
        let mut found = HeldOut {
            kind: held_out.name().to_owned(),
            source: None,
            from_s: None,
            seconds: None,
            at_rest: None,
        };
        match held_out {
            diagnose::HeldOut::Recording(source) => found.source = Some(source.clone()),
            diagnose::HeldOut::End {
                from_s,
                seconds,
                at_rest,
                ..
            } => {
                found.from_s = Some(*from_s);
                found.seconds = Some(*seconds);
                found.at_rest = Some(*at_rest);
            }
            diagnose::HeldOut::Nothing => {}
        }
        found
    }
}

impl Alternative {
    /// A refit, as `chosen` or `alternative`.
    pub fn new(role: &str, refit: &FittedModel) -> Self {
        Alternative {
            effects: effects(refit),
            formulas: (refit.effects.iter())
                .filter_map(|kind| servoid_formula::text_of(*kind).map(str::to_owned))
                .collect(),
            role: role.to_owned(),
            machine: Machine::from(&refit.candidate.machine),
            parameters: ModelParameter::all(&refit.effects, &refit.parameters),
            rms_counts: finite(refit.rms_counts),
            validate_rms_counts: finite(refit.validate_rms_counts),
        }
    }
}

fn effects(refit: &FittedModel) -> Vec<String> {
    let effects = refit.effects.iter();
    effects.map(|kind| kind.name().to_owned()).collect()
}
