//! `servoid diagnose`: where the linear motor fails, and what is missing.

use super::progress::Watched;
use super::{motor, report};
use crate::cli::DiagnoseArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_identify::diagnose::Budget;
use servoid_identify::diagnose::steady;
use servoid_identify::fit::Options;
use servoid_identify::{Datasets, diagnose_datasets};
use servoid_io::input::SteadyCurve;
use servoid_results::report::diagnosis::{DiagnosisReport, SteadyReport};
use servoid_results::report::html;
use servoid_results::schema::{Diagnosis, Steady};

/// The unit of --budget, steps of a model.
const MILLION: u64 = 1_000_000;

pub(super) fn run(session: &Session, args: &DiagnoseArgs) -> Result<(), Error> {
    let page = report::output(&args.sheet);
    motor::check_outputs(
        session,
        page.as_slice(),
        &args.motor,
        &args.recording,
        args.validate.as_deref(),
    )?;
    if SteadyCurve::is_in(&args.recording) {
        return steady(session, args);
    }
    let (recording, motor_file) = motor::recording(&args.motor, &args.recording)?;
    let other = args
        .validate
        .as_ref()
        .map(|path| motor::recording(&args.motor, path))
        .transpose()?;
    let options = Options {
        known: motor_file.known,
        seed: session.seed,
        force: args.force,
        ..Options::default()
    };
    let datasets = Datasets::new(recording, other.map(|(other, _)| other), &options)?;
    let budget = Budget::of(args.budget.saturating_mul(MILLION), session.stop());
    let watched = Watched::diagnosis(session);
    let found = diagnose_datasets(&datasets, &options, &budget, &watched)?;
    drop(watched);
    let Datasets { fitted, kind, .. } = &datasets;
    let told = DiagnosisReport::new(&found, fitted, kind, session.seed, session.json_file());
    let json = Diagnosis::from(&told);
    let drawn = html::Recordings {
        fitted: Some(datasets.whole.as_deref().unwrap_or(fitted)),
        held_out: kind.source().map(|_| &datasets.held_out),
    };
    report::write(session, &args.sheet, &json, drawn)?;
    session.deliver(&told.text(), &json)
}

/// A curve of steady speeds in the place of a recording.
fn steady(session: &Session, args: &DiagnoseArgs) -> Result<(), Error> {
    if args.validate.is_some() {
        return Err(Error::Usage(format!(
            "--validate: {} is a curve of steady speeds, which is diagnosed on its own; leave --validate away",
            args.recording.display()
        )));
    }
    let curve = SteadyCurve::read(&args.recording)?;
    let diagnosis = steady::diagnose(&curve)?;
    let told = SteadyReport {
        curve: &curve,
        diagnosis: &diagnosis,
        seed: session.seed,
    };
    let json = Steady::from(&told);
    report::write(session, &args.sheet, &json, html::Recordings::default())?;
    session.deliver(&told.text(), &json)
}
