//! `servoid diagnose`: where the linear motor fails, and what is missing.

use super::diagnosing::diagnosed;
use super::{motor, report};
use crate::cli::DiagnoseArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_identify::diagnose::steady;
use servoid_identify::diagnose::{Effort, HeldOut, Remark, holdout, pair, usable};
use servoid_identify::fit::{self, Options};
use servoid_io::input::SteadyCurve;
use servoid_io::output::is_same_file;
use servoid_results::report::diagnosis::SteadyReport;
use servoid_results::report::html;
use servoid_results::schema::{Diagnosis, Steady};
use std::sync::Arc;

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
    let (options, recordings) = recordings(session, args)?;
    let Recordings {
        data,
        held_out,
        kind,
        remarks,
        whole,
    } = &recordings;
    let effort = Effort::of(args.budget.saturating_mul(MILLION), session.stop());
    let diagnosed = diagnosed(session, data, held_out, &options, &effort)?;
    let mut remarks = remarks.clone();
    if !diagnosed.interrupted && !diagnosed.diagnosis.ran_out {
        let stop = session.stop();
        remarks.extend(pair::remarks(
            &diagnosed.diagnosis,
            data,
            held_out,
            kind,
            &options,
            stop,
        )?);
    }
    let told = diagnosed.report(session, data, kind, remarks);
    let json = Diagnosis::from(&told);
    let drawn = html::Recordings {
        fitted: Some(whole.as_deref().unwrap_or(data)),
        held_out: kind.source().map(|_| held_out),
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

struct Recordings {
    data: Data,
    held_out: Data,
    kind: HeldOut,
    /// What was seen in them.
    remarks: Vec<Remark>,
    /// The only recording, where its end is held out.
    whole: Option<Arc<Data>>,
}

/// Reads what is fitted and what is held out.
fn recordings(session: &Session, args: &DiagnoseArgs) -> Result<(Options, Recordings), Error> {
    let (recording, motor_file) = motor::recording(&args.motor, &args.recording)?;
    let options = Options {
        known: motor_file.known,
        seed: session.seed,
        ..Options::default()
    };
    let mut remarks = usable::check(&recording)?;
    let Some(path) = &args.validate else {
        let (first, rest, kind) = holdout::cut(&recording).ok_or_else(|| {
            Error::Failed(format!(
                "{}: {:.3} s are too short to hold a part of them out; give another recording of the same motor with \
                 --validate, or record some seconds",
                recording.source,
                recording.duration_s()
            ))
        })?;
        first.check_excited()?;
        rest.check_excited()?;
        let whole = Arc::new(Data::taken(recording)?);
        let recordings = Recordings {
            data: Data::taken(first)?,
            held_out: Data::taken(rest)?.at_end_of(Arc::clone(&whole)),
            kind,
            remarks,
            whole: Some(whole),
        };
        return Ok((options, recordings));
    };
    let other = motor::recording(&args.motor, path)?.0;
    remarks.extend(usable::check(&other)?);
    let copied = other.counts == recording.counts && other.command == recording.command;
    let kind = if copied || is_same_file(path, &args.recording) {
        HeldOut::Nothing
    } else {
        HeldOut::Recording(other.source.clone())
    };
    if kind == HeldOut::Nothing {
        remarks.clear();
        remarks.extend(usable::check(&recording)?);
        remarks.push(Remark::aside(
            "--validate is the recording itself: nothing is held out, and an effect that only bends itself to this one \
             recording would not be found out"
                .to_owned(),
        ));
    }
    let (data, held_out) = (Data::taken(recording)?, Data::taken(other)?);
    for data in [&data, &held_out] {
        if fit::is_reversed(data, &options) {
            // The message with its remedy.
            fit::problem(data, &options)?;
        }
    }
    let recordings = Recordings {
        data,
        held_out,
        kind,
        remarks,
        whole: None,
    };
    Ok((options, recordings))
}
