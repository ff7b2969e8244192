//! `servoid.diagnosis/1`. Keys are only ever added.

use super::whereabouts::{ResidualJson, WhereJson};
use super::{DiagnosisReport, Role};
use crate::kept::{KeptMachine, KeptModel, KeptParameter};
use crate::report::json::{IdentifiableJson, MarginsJson, ParameterJson};
use serde::Serialize;
use servoid_identify::diagnose::{Errors, FittedModel, HeldOut, Remark, Step};
use shared::encoder::FLOOR_RMS_COUNTS;

/// A number, or null where there is none.
pub(super) fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

/// A diagnosis.
#[derive(Debug, Serialize)]
pub struct DiagnosisJson {
    schema: &'static str,
    quantization_floor_counts: f64,
    base: BaseJson,
    verdict: &'static str,
    summary: String,
    steps: Vec<StepJson>,
    #[serde(rename = "final")]
    last: FinalJson,
    not_named: Option<&'static str>,
    advice: Vec<String>,
    next_command: Option<String>,
    cannot_tell: Vec<String>,
    cause: Option<String>,
    remarks: Vec<String>,
    residual: ResidualJson,
    held_out: HeldOutJson,
    window_s: Option<f64>,
    window_reason: Option<String>,
    models: Vec<ModelJson>,
    supply_v: f64,
    no_load_rad_s: Option<f64>,
    counts_per_rev: f64,
    sample_s: f64,
    recording: String,
    drive: &'static str,
    seed: u64,
    interrupted: bool,
    ran_out: bool,
    model_steps: u64,
    version: &'static str,
}

#[derive(Debug, Serialize)]
struct BaseJson {
    effects: Vec<&'static str>,
    model: KeptModel,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
}

#[derive(Debug, Serialize)]
struct ErrorsJson {
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
}

#[derive(Debug, Serialize)]
struct StepJson {
    added: &'static str,
    indistinguishable_from: Vec<&'static str>,
    refined_by: Vec<&'static str>,
    confidence: Option<f64>,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
    foreseen_rms_counts: Option<f64>,
    tracked: Option<ErrorsJson>,
    tracked_memory_s: Option<f64>,
    followed: Option<f64>,
    windowed: Option<ErrorsJson>,
    evidence: String,
    model: Option<KeptModel>,
    #[serde(rename = "where")]
    whereabouts: Option<WhereJson>,
    candidates: Vec<CandidateJson>,
}

#[derive(Debug, Serialize)]
struct CandidateJson {
    effect: &'static str,
    effects: Vec<&'static str>,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
    foreseen_rms_counts: Option<f64>,
    tracked: Option<ErrorsJson>,
    windowed: Option<ErrorsJson>,
    p_value: Option<f64>,
    evaluations: usize,
}

#[derive(Debug, Serialize)]
struct FinalJson {
    effects: Vec<&'static str>,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
    parameters: Vec<ParameterJson>,
    converged: bool,
    notes: Vec<String>,
    model: KeptModel,
    identifiable: IdentifiableJson,
    margins: Option<MarginsJson>,
}

#[derive(Debug, Serialize)]
struct HeldOutJson {
    kind: &'static str,
    source: Option<String>,
    from_s: Option<f64>,
    seconds: Option<f64>,
    at_rest: Option<bool>,
}

#[derive(Debug, Serialize)]
struct ModelJson {
    effects: Vec<&'static str>,
    role: &'static str,
    machine: KeptMachine,
    parameters: Vec<KeptParameter>,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
}

impl From<&DiagnosisReport<'_>> for DiagnosisJson {
    fn from(report: &DiagnosisReport<'_>) -> Self {
        let diagnosis = report.diagnosis;
        let (rms, validate) = report.last_errors();
        // The fastest speed of the linear motor on its supply, or the fastest seen.
        let gain = diagnosis.last.candidate.machine.response().gain;
        let no_load = (gain * report.data.supply).max(report.data.units.speed);
        DiagnosisJson {
            schema: "servoid.diagnosis/1",
            quantization_floor_counts: FLOOR_RMS_COUNTS,
            base: BaseJson {
                effects: Vec::new(),
                model: kept(&diagnosis.base),
                rms_counts: finite(diagnosis.base.rms_counts),
                validate_rms_counts: finite(diagnosis.base.validate_rms_counts),
            },
            verdict: report.verdict().name(),
            summary: report.verdict_text(),
            steps: (0..diagnosis.steps.len())
                .map(|k| step(report, k))
                .collect(),
            last: FinalJson {
                effects: report.effects(),
                rms_counts: finite(rms),
                validate_rms_counts: finite(validate),
                parameters: report.last.parameters.iter().map(Into::into).collect(),
                converged: report.last.converged,
                notes: report.last.notes.clone(),
                model: KeptModel::of(&report.last.candidate, report.last.method),
                identifiable: IdentifiableJson::from(report.last.response),
                margins: report.last.margins.map(MarginsJson::from),
            },
            not_named: diagnosis.not_named.map(|kind| kind.name()),
            advice: report.advice(),
            next_command: report.next_command(),
            cannot_tell: report.cannot_tell(),
            cause: report.cause().map(Remark::to_string),
            remarks: report.remarks.iter().map(Remark::to_string).collect(),
            residual: ResidualJson::from(report.findings),
            held_out: held_out(report.held_out),
            window_s: diagnosis.span.window_s.and_then(finite),
            window_reason: (diagnosis.span.window_s).map(|_| diagnosis.span.reason.clone()),
            models: report.models().iter().map(model).collect(),
            supply_v: report.data.supply,
            no_load_rad_s: finite(no_load),
            counts_per_rev: report.data.units.counts_per_rev,
            sample_s: report.data.units.interval,
            recording: (report.held_out.whole())
                .unwrap_or(&report.data.source)
                .to_owned(),
            drive: report.data.drive.name(),
            seed: report.seed,
            interrupted: report.interrupted,
            ran_out: diagnosis.ran_out,
            model_steps: diagnosis.steps_taken,
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}

fn step(report: &DiagnosisReport<'_>, index: usize) -> StepJson {
    let step: &Step = &report.diagnosis.steps[index];
    let names = step.indistinguishable_from.iter().map(|kind| kind.name());
    let after = step.candidates.first();
    let of = |value: fn(&FittedModel) -> f64| after.map(value).and_then(finite);
    StepJson {
        added: step.added.name(),
        indistinguishable_from: names.collect(),
        refined_by: super::names(&report.refinements(step)),
        confidence: finite(step.confidence),
        rms_counts: of(|refit| refit.rms_counts),
        validate_rms_counts: of(|refit| refit.validate_rms_counts),
        foreseen_rms_counts: of(|refit| refit.predicted_rms_counts),
        tracked: after
            .and_then(|refit| refit.observed)
            .map(|t| errors(t.errors)),
        tracked_memory_s: after.and_then(|refit| refit.observed).map(|t| t.memory_s),
        followed: after
            .map(|refit| refit.followed_fraction)
            .filter(|part| *part > 0.0),
        windowed: after.and_then(|refit| refit.windowed).map(errors),
        evidence: report.evidence(index),
        model: after.map(kept),
        whereabouts: (report.findings.steps.get(index))
            .and_then(Option::as_ref)
            .map(WhereJson::from),
        candidates: (step.candidates.iter().zip(&step.p_values))
            .map(|(refit, p_value)| candidate(refit, *p_value))
            .collect(),
    }
}

fn candidate(refit: &FittedModel, p_value: f64) -> CandidateJson {
    let effects: Vec<&'static str> = refit.effects.iter().map(|kind| kind.name()).collect();
    CandidateJson {
        effect: effects.last().copied().unwrap_or_default(),
        effects,
        rms_counts: finite(refit.rms_counts),
        validate_rms_counts: finite(refit.validate_rms_counts),
        foreseen_rms_counts: finite(refit.predicted_rms_counts),
        tracked: refit.observed.map(|t| errors(t.errors)),
        windowed: refit.windowed.map(errors),
        p_value: finite(p_value),
        evaluations: refit.evaluations,
    }
}

fn errors(errors: Errors) -> ErrorsJson {
    ErrorsJson {
        rms_counts: finite(errors.fitted),
        validate_rms_counts: finite(errors.held_out),
    }
}

fn held_out(held_out: &HeldOut) -> HeldOutJson {
    let kind = held_out.name();
    match held_out {
        HeldOut::Recording(source) => HeldOutJson {
            kind,
            source: Some(source.clone()),
            from_s: None,
            seconds: None,
            at_rest: None,
        },
        HeldOut::End {
            from_s,
            seconds,
            at_rest,
            ..
        } => HeldOutJson {
            kind,
            source: None,
            from_s: Some(*from_s),
            seconds: Some(*seconds),
            at_rest: Some(*at_rest),
        },
        HeldOut::Nothing => HeldOutJson {
            kind,
            source: None,
            from_s: None,
            seconds: None,
            at_rest: None,
        },
    }
}

/// A model that can be run again; counts that were lost are not put back.
fn kept(refit: &FittedModel) -> KeptModel {
    KeptModel::of(&refit.candidate, refit.method)
}

fn model(role: &Role<'_>) -> ModelJson {
    let model = role.model;
    let mut values = model.parameters.iter();
    let mut parameters = Vec::new();
    for kind in &model.effects {
        for parameter in kind.description().parameters {
            parameters.extend(values.next().map(|value| KeptParameter {
                name: format!("{}.{}", kind.name(), parameter.name),
                value: *value,
                unit: parameter.quantity.unit().to_owned(),
            }));
        }
    }
    ModelJson {
        effects: model.effects.iter().map(|kind| kind.name()).collect(),
        role: role.name,
        machine: KeptMachine::from(&model.candidate.machine),
        parameters,
        rms_counts: finite(model.rms_counts),
        validate_rms_counts: finite(model.validate_rms_counts),
    }
}
