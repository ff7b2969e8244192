//! `servoid diagnose`: where the linear motor fails, and what is missing.

use super::progress::Watched;
use super::{formula, motor, report};
use crate::cli::DiagnoseArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_identify::diagnose::Budget;
use servoid_identify::fit::Options;
use servoid_identify::steady;
use servoid_identify::{Datasets, diagnose_datasets};
use servoid_io::input::SteadyCurve;
use servoid_results::report::diagnosis::{DiagnosisReport, SteadyReport};
use servoid_results::report::html;
use servoid_results::schema::{Diagnosis, Steady};
use std::path::Path;

/// The unit of --budget, steps of a model.
const MILLION: u64 = 1_000_000;

pub(super) fn run(session: &Session, args: &DiagnoseArgs) -> Result<(), Error> {
    let page = report::output(&args.page);
    if let Some(curve) = args
        .recordings
        .first()
        .filter(|path| SteadyCurve::is_in(path))
    {
        motor::check_outputs(session, page.as_slice(), &args.motor, curve, None)?;
        return steady(session, args, curve);
    }
    let read = motor::read(session, page.as_slice(), &args.motor, &args.recordings)?;
    let options = Options {
        known: read.motor.known,
        seed: session.seed,
        force: args.force,
        candidates: formula::stated(&args.formulas)?,
        discover: args.discover,
        ..Options::default()
    };
    let name = read.motor.name;
    let datasets = Datasets::of_several(read.fitted, read.held_out, &options)?;
    let budget = Budget::of(args.budget.saturating_mul(MILLION), session.stop());
    let watched = Watched::diagnosis(session);
    let found = diagnose_datasets(&datasets, &options, &budget, &watched)?;
    drop(watched);
    let Datasets { fitted, kind, .. } = &datasets;
    let outcome = DiagnosisReport::new(&found, fitted, kind, session.seed, session.json_file());
    let json = Diagnosis {
        read: Some(read.how),
        ..Diagnosis::from(&outcome)
    };
    let drawn = html::Recordings {
        fitted: Some(datasets.whole.as_deref().unwrap_or(fitted)),
        held_out: kind.source().map(|_| &datasets.held_out),
    };
    report::write(session, &args.page, name.as_deref(), &json, drawn)?;
    session.deliver(&outcome.text(), &json)
}

/// A curve of steady speeds in the place of a recording.
fn steady(session: &Session, args: &DiagnoseArgs, path: &Path) -> Result<(), Error> {
    if !args.recordings.held_out().is_empty() || args.recordings.fitted().len() > 1 {
        return Err(Error::Usage(format!(
            "{} is a curve of steady speeds, which is diagnosed on its own; leave the other recordings and --validate away",
            path.display()
        )));
    }
    let curve = SteadyCurve::read(path)?;
    let diagnosis = steady::fit_curve(&curve)?;
    let outcome = SteadyReport {
        curve: &curve,
        diagnosis: &diagnosis,
        seed: session.seed,
    };
    let json = Steady::from(&outcome);
    report::write(
        session,
        &args.page,
        None,
        &json,
        html::Recordings::default(),
    )?;
    session.deliver(&outcome.text(), &json)
}
