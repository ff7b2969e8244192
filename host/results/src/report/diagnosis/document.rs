//! A diagnosis as the document that is written.

use super::DiagnosisReport;
use crate::schema::diagnosis::{Alternative, Base, Candidate, Final, HeldOut, SCHEMA, Step};
use crate::schema::residual::{Residual, Where};
use crate::schema::{Diagnosis, Model, PositionLoop, VERSION, finite};
use servoid_identify::diagnose::{self, FittedModel, Remark};
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;

impl From<&DiagnosisReport<'_>> for Diagnosis {
    fn from(report: &DiagnosisReport<'_>) -> Self {
        let diagnosis = report.diagnosis;
        // The fastest speed of the linear motor on its supply, or the fastest seen.
        let gain = diagnosis.last.candidate.machine.response().gain;
        let no_load = (gain * report.data.supply).max(report.data.units.speed);
        let models = report.models();
        let mut written = Diagnosis {
            schema: SCHEMA.to_owned(),
            quantization_floor_counts: Some(FLOOR_RMS_COUNTS),
            base: Base::from(&diagnosis.base),
            verdict: report.verdict().name().to_owned(),
            summary: report.verdict_text(),
            steps: (0..diagnosis.steps.len())
                .map(|k| step(report, k))
                .collect(),
            last: Final::new(
                report.last,
                names(&diagnosis.last.effects),
                report.last_errors(),
            ),
            not_named: diagnosis.not_named.map(|kind| kind.name().to_owned()),
            advice: report.advice(),
            next_command: report.next_command(),
            cannot_tell: report.cannot_tell(),
            cause: report.cause().map(Remark::to_string),
            remarks: report.remarks.iter().map(Remark::to_string).collect(),
            proposed: (report.proposed).map(|laws| laws.iter().map(Into::into).collect()),
            residual: Residual::from(report.findings),
            held_out: HeldOut::from(report.held_out),
            window_s: diagnosis.span.window_s.and_then(finite),
            window_reason: (diagnosis.span.window_s).map(|_| diagnosis.span.reason.clone()),
            baseline: diagnosis.baseline.as_ref().map(Into::into),
            process_noise: (report.last.likelihood.as_ref()).map(|own| own.process_noise.into()),
            likelihood: report.last.likelihood.as_ref().map(Into::into),
            hypotheses: diagnosis.hypotheses.iter().map(Into::into).collect(),
            floor: diagnosis.floor.as_ref().map(Into::into),
            explained_share: diagnosis.explained_share().and_then(finite),
            lack_of_fit: (diagnosis.floor)
                .and_then(|floor| floor.repeats)
                .map(|repeats| repeats.last.into()),
            explained_percent: finite(report.explained_percent()),
            prediction: diagnosis.predicts.map(Into::into),
            models: (models.iter())
                .map(|role| Alternative::new(role.name, role.model))
                .collect(),
            supply_v: finite(report.data.supply),
            no_load_rad_s: finite(no_load),
            counts_per_rev: finite(report.data.units.counts_per_rev),
            sample_s: finite(report.data.units.interval),
            recording: (report.held_out.whole())
                .unwrap_or(&report.data.source)
                .to_owned(),
            recordings: report.recordings.iter().map(Into::into).collect(),
            drive: report.data.drive.name().to_owned(),
            position_loops: PositionLoop::all(report.data),
            seed: report.seed,
            read: None,
            interrupted: report.interrupted,
            ran_out: diagnosis.ran_out,
            model_steps: diagnosis.steps_taken,
            version: VERSION.to_owned(),
        };
        written.in_terms_of(report.data.drive);
        written
    }
}

fn step(report: &DiagnosisReport<'_>, index: usize) -> Step {
    let step: &diagnose::Step = &report.diagnosis.steps[index];
    let after = step.candidates.first();
    let of = |value: fn(&FittedModel) -> f64| after.map(value).and_then(finite);
    let tracked = after.and_then(|refit| refit.observed);
    Step {
        added: step.added.name().to_owned(),
        indistinguishable_from: names(&step.indistinguishable_from),
        refined_by: names(&report.refinements(step)),
        confidence: finite(step.confidence),
        rms_counts: of(|refit| refit.rms_counts),
        validate_rms_counts: of(|refit| refit.validate_rms_counts),
        foreseen_rms_counts: of(|refit| refit.predicted_rms_counts),
        tracked: tracked.map(|tracked| tracked.errors.into()),
        tracked_memory_s: tracked.map(|tracked| tracked.memory_s),
        followed: after
            .map(|refit| refit.followed_fraction)
            .filter(|part| *part > 0.0),
        windowed: after.and_then(|refit| refit.windowed).map(Into::into),
        evidence: report.evidence(index),
        model: after.map(|refit| Model::of(&refit.candidate, refit.method)),
        whereabouts: (report.findings.steps.get(index))
            .and_then(Option::as_ref)
            .map(Where::from),
        curve: (report.findings.curves.get(index))
            .and_then(Option::as_ref)
            .map(Into::into),
        candidates: (step.candidates.iter().zip(&step.p_values))
            .map(|(refit, p_value)| Candidate::new(refit, *p_value))
            .collect(),
    }
}

fn names(kinds: &[Kind]) -> Vec<String> {
    kinds.iter().map(|kind| kind.name().to_owned()).collect()
}
