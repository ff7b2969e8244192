//! What is read again of the results that other verbs wrote; keys that are not named here are ignored.

use super::{KeptEstimate, KeptModel};
use serde::Deserialize;
use std::collections::BTreeMap;

/// `servoid.fit/1`; `demo` writes it with its diagnosis.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptFit {
    /// Search method.
    pub algorithm: String,
    /// Model evaluations that it took.
    pub evaluations: usize,
    /// Least cost.
    pub cost: f64,
    /// Name of the cost.
    pub cost_kind: String,
    /// RMS of the free run's error, counts.
    pub rms_counts: f64,
    /// The same on the other recording.
    pub validate_rms_counts: Option<f64>,
    /// Whether the search came to its end.
    pub converged: bool,
    /// Effects beside the linear motor.
    pub effects: Vec<String>,
    /// Parameters with their errors.
    pub parameters: Vec<KeptEstimate>,
    /// What a user should know.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Errors as effects are added.
    #[serde(default)]
    pub ladder: Vec<KeptRung>,
    /// The model.
    pub model: KeptModel,
    /// The fitted recording.
    pub recording: String,
    /// The held-out recording.
    pub validate: Option<String>,
    /// Seed of the search.
    pub seed: u64,
    /// Whether the user stopped it.
    #[serde(default)]
    pub interrupted: bool,
    /// What the demonstration hid.
    pub hidden: Option<String>,
    /// How far off its parameters are, which only a bench can tell.
    #[serde(default)]
    pub parameter_errors: Vec<KeptMiss>,
    /// The demonstration's diagnosis.
    pub diagnosis: Option<Box<KeptDiagnosis>>,
}

/// How far off a parameter is from the truth.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptMiss {
    /// The effect.
    pub effect: String,
    /// Its parameter.
    pub parameter: String,
    /// Per cent.
    pub percent: f64,
}

/// Errors of a model on the way.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptRung {
    /// The effect that was added last.
    pub added: Option<String>,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
}

/// `servoid.diagnosis/1` of two recordings.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptDiagnosis {
    /// The linear motor.
    pub base: KeptBase,
    /// `complete`, `missing_effects`, `unexplained` or `inconclusive`.
    pub verdict: String,
    /// The verdict in two sentences.
    #[serde(default)]
    pub summary: String,
    /// The effects in the order in which they were added.
    pub steps: Vec<KeptStep>,
    /// The model with all of them.
    #[serde(rename = "final")]
    pub last: KeptFinal,
    /// What would reduce the error most and was not believed.
    pub not_named: Option<String>,
    /// What to do next.
    #[serde(default)]
    pub advice: Vec<String>,
    /// What these recordings cannot tell.
    #[serde(default)]
    pub cannot_tell: Vec<String>,
    /// What to know about the recordings.
    #[serde(default)]
    pub remarks: Vec<String>,
    /// What was held out.
    pub held_out: KeptHeldOut,
    /// The fitted recording.
    pub recording: String,
    /// Seed of everything random.
    pub seed: u64,
    /// Whether the user stopped the work.
    #[serde(default)]
    pub interrupted: bool,
}

/// `servoid.diagnosis/1` of a curve of steady speeds.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptSteady {
    /// `complete`, `unexplained` or `inconclusive`.
    pub verdict: String,
    /// The verdict in words.
    pub summary: String,
    /// What to do next.
    #[serde(default)]
    pub advice: Vec<String>,
    /// The curve and its lines.
    pub steady: KeptCurve,
    /// Where it came from.
    pub recording: String,
}

/// A curve of steady speeds and the lines through it.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptCurve {
    /// Voltage, V, and speed, rad/s.
    pub curve: Vec<(f64, f64)>,
    /// The line through the origin.
    pub linear: KeptLine,
    /// The line with a drop.
    pub with_drop: KeptLine,
    /// Effects that make such a drop, none before the other.
    #[serde(default)]
    pub indistinguishable: Vec<String>,
}

/// A line through steady speeds.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct KeptLine {
    /// V·s/rad.
    pub slope_v_s_rad: f64,
    /// V.
    pub drop_v: f64,
    /// RMS error as a part of the voltage's RMS.
    pub relative: f64,
}

/// The linear motor of a diagnosis.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptBase {
    /// Its numbers.
    pub model: KeptModel,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
}

/// The last model of a diagnosis.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptFinal {
    /// Its effects.
    pub effects: Vec<String>,
    /// Its numbers.
    pub model: KeptModel,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// Parameters with their errors.
    pub parameters: Vec<KeptEstimate>,
    /// Whether its fit came to its end.
    pub converged: bool,
    /// What a user should know.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// One effect that was added.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptStep {
    /// The effect.
    pub added: String,
    /// What explains the data as well.
    #[serde(default)]
    pub indistinguishable_from: Vec<String>,
    /// Those of them that only refine it: they can do what it does, and the data do not ask for more.
    #[serde(default)]
    pub refined_by: Vec<String>,
    /// From one half to one.
    pub confidence: Option<f64>,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// What was foreseen before the refit, counts RMS.
    pub foreseen_rms_counts: Option<f64>,
    /// What speaks for it.
    #[serde(default)]
    pub evidence: String,
    /// Everything that was tried, best first.
    #[serde(default)]
    pub candidates: Vec<KeptCandidate>,
}

/// One effect that was tried.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptCandidate {
    /// The effect.
    pub effect: String,
    /// On what was fitted, counts RMS.
    pub rms_counts: Option<f64>,
    /// On what was held out, counts RMS.
    pub validate_rms_counts: Option<f64>,
    /// What was foreseen before the refit, counts RMS.
    pub foreseen_rms_counts: Option<f64>,
    /// Chance of so large a gain if the effect were absent.
    pub p_value: Option<f64>,
}

/// What was held out.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptHeldOut {
    /// `recording`, `end` or `nothing`.
    pub kind: String,
    /// The other recording.
    pub source: Option<String>,
    /// Where the held-out end begins, s.
    pub from_s: Option<f64>,
}

/// `servoid.compare/1`, of `compare` or of `paper`.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptContest {
    /// Model evaluations of each run.
    pub budget: usize,
    /// Seeds.
    pub seeds: Vec<u64>,
    /// Methods.
    pub rows: Vec<KeptRow>,
    /// Least cost that anything found, of `paper` only.
    pub optimum_cost: Option<f64>,
    /// Cost of the true motor, of `paper` only.
    pub truth_cost: Option<f64>,
    /// The paper's treatments, the first being `rows` again.
    #[serde(default)]
    pub variants: Vec<KeptVariant>,
}

/// One treatment of the paper's contest.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptVariant {
    /// Its name.
    pub name: String,
    /// Cost of the true motor.
    pub truth_cost: Option<f64>,
    /// Methods.
    pub rows: Vec<KeptRow>,
}

/// One method.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptRow {
    /// Its name; `actual` for the paper's true motor.
    pub algorithm: String,
    /// Over the seeds.
    pub median_cost: Option<f64>,
    /// Of the best run.
    pub best_cost: Option<f64>,
    /// Of the worst run.
    pub worst_cost: Option<f64>,
    /// The middle half.
    pub quartiles_cost: Option<[f64; 2]>,
    /// Evaluations to within 1 % of the least cost.
    pub median_evaluations_to_1pct: Option<f64>,
    /// Computing time of all runs, s.
    pub wall_s: Option<f64>,
    /// Of the best run.
    pub margins: Option<KeptMargins>,
    /// Coefficients of the position loop of the best run.
    #[serde(rename = "loop")]
    pub position_loop: Option<KeptLoop>,
    /// Evaluations and median best cost.
    #[serde(default)]
    pub curve: Vec<(usize, f64)>,
    /// Evaluations, and the quartiles of the best cost.
    #[serde(default)]
    pub curve_band: Vec<(usize, f64, f64)>,
    /// What the paper prints.
    pub paper: Option<KeptPrinted>,
}

/// A column of the paper's table.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptPrinted {
    /// Cost, deg·s.
    pub cost: Option<f64>,
    /// The six parameters, SI.
    pub parameters: BTreeMap<String, f64>,
    /// As printed.
    pub margins_printed: KeptMargins,
    /// From the printed parameters.
    pub margins_computed: Option<KeptMargins>,
}

/// Margins of the position loop.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct KeptMargins {
    /// dB; none where infinite.
    pub gain_db: Option<f64>,
    /// Degrees.
    pub phase_deg: f64,
}

/// Coefficients of the position loop's denominator `s·(a3·s² + a2·s + a1)`.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct KeptLoop {
    /// V·s³/rad.
    pub a3: f64,
    /// V·s²/rad.
    pub a2: f64,
    /// V·s/rad.
    pub a1: f64,
}

/// `servoid.verify/1`.
#[derive(Clone, Debug, Deserialize)]
pub struct KeptVerification {
    /// Whether the host found the device's bits.
    pub same_bits: bool,
    /// Whether the device's answer stands.
    pub stands: bool,
    /// In words.
    pub verdict: String,
    /// Of the long recording.
    pub diagnosis: Option<Box<KeptDiagnosis>>,
}
