//! `servoid diagnose`: where the linear motor fails, and what is missing.

use super::diagnosing::diagnosed;
use super::motor;
use crate::cli::DiagnoseArgs;
use crate::diagnose::steady::SteadyCurve;
use crate::diagnose::{Effort, HeldOut, Remark, holdout, pair, usable};
use crate::error::Error;
use crate::fit::{self, Options};
use crate::output::is_same_file;
use crate::problem::Data;
use crate::report::diagnosis::{DiagnosisJson, SteadyJson, SteadyReport};
use crate::session::Session;

/// The unit of --budget, steps of a model.
const MILLION: u64 = 1_000_000;

pub(super) fn run(session: &Session, args: &DiagnoseArgs) -> Result<(), Error> {
    motor::check_outputs(
        session,
        &[],
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
    let report = diagnosed.report(session, data, kind, remarks);
    session.deliver(&report.text(), &DiagnosisJson::from(&report))
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
    let diagnosis = curve.diagnose()?;
    let report = SteadyReport {
        curve: &curve,
        diagnosis: &diagnosis,
        seed: session.seed,
    };
    session.deliver(&report.text(), &SteadyJson::from(&report))
}

struct Recordings {
    data: Data,
    held_out: Data,
    kind: HeldOut,
    /// What was seen in them.
    remarks: Vec<Remark>,
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
        let recordings = Recordings {
            data: Data::new(&first)?,
            held_out: Data::new(&rest)?,
            kind,
            remarks,
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
    let (data, held_out) = (Data::new(&recording)?, Data::new(&other)?);
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
    };
    Ok((options, recordings))
}
