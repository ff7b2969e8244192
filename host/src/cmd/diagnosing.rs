//! A diagnosis with its progress, as every verb that diagnoses needs it.

use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{self, Budget, Diagnosis, Findings, HeldOut, Remark};
use servoid_identify::fit::{Fit, Options};
use servoid_results::report::diagnosis::DiagnosisReport;
use std::sync::atomic::Ordering;

/// A diagnosis, its last model fitted to the end, and where the models fail.
pub(super) struct Diagnosed {
    pub(super) diagnosis: Diagnosis,
    pub(super) last: Fit,
    pub(super) findings: Findings,
    /// Whether the user stopped the search for effects.
    pub(super) interrupted: bool,
}

impl Diagnosed {
    /// As it is reported.
    pub(super) fn report<'a>(
        &'a self,
        session: &'a Session,
        data: &'a Data,
        held_out: &'a HeldOut,
        remarks: Vec<Remark>,
    ) -> DiagnosisReport<'a> {
        DiagnosisReport {
            data,
            held_out,
            diagnosis: &self.diagnosis,
            last: &self.last,
            findings: &self.findings,
            remarks,
            seed: session.seed,
            interrupted: self.interrupted,
            json: session.json_file(),
        }
    }
}

/// Diagnoses `data`, judged by `held_out`, and shows that it goes on.
pub(super) fn diagnosed(
    session: &Session,
    data: &Data,
    held_out: &Data,
    options: &Options,
    budget: &Budget<'_>,
) -> Result<Diagnosed, Error> {
    // How many models will be fitted shows only as they are.
    let bar = session.count("diagnose", "models tried");
    let done = || bar.inc(1);
    let diagnosis = diagnose::diagnose(data, held_out, options, budget, &done);
    bar.finish_and_clear();
    let diagnosis = diagnosis?;
    let stop = budget.stop();
    let interrupted = stop.load(Ordering::Relaxed);
    let last = diagnose::settle(&diagnosis, data, held_out, options, stop)?;
    let findings = diagnose::findings(&diagnosis, data, held_out)?;
    Ok(Diagnosed {
        diagnosis,
        last,
        findings,
        interrupted,
    })
}
