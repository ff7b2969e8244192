//! `servoid fit`: a model of one recording.

use super::progress::Watched;
use super::{model, motor, report};
use crate::cli::FitArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_identify::fit::Options;
use servoid_identify::{check, identify_data, is_copy};
use servoid_io::output::write_whole;
use servoid_results::plot;
use servoid_results::report::{html, text};
use servoid_results::schema;

pub(super) fn run(session: &Session, args: &FitArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    let outputs: Vec<_> = plot
        .into_iter()
        .chain(report::output(&args.sheet))
        .collect();
    motor::check_outputs(
        session,
        &outputs,
        &args.motor,
        &args.recording,
        args.validate.as_deref(),
    )?;
    let (recording, motor_file) = motor::recording(&args.motor, &args.recording)?;
    for finding in check::passed(&recording, args.force)? {
        session.remark(&finding.text());
    }
    let data = Data::taken(recording)?;
    let validation = match &args.validate {
        Some(path) => Some(Data::taken(motor::recording(&args.motor, path)?.0)?),
        None => None,
    };
    let copied = |other: &Data| is_copy(&data, other);
    if validation.as_ref().is_some_and(copied) {
        session.remark("--validate is the recording itself: nothing is held out; give another recording of the same motor");
    }
    let validation = validation.filter(|other| !copied(other));
    let options = Options {
        algorithm: args.algorithm.clone(),
        error_ladder: true,
        force: args.force,
        ..model::options(&args.model, motor_file.known, session.seed, args.budget)?
    };
    let watched = Watched::search(session, options.budget);
    let fit = identify_data(&data, validation.as_ref(), &options, &watched)?;
    drop(watched);
    if let Some(path) = &args.plot {
        let drawing = plot::overlay(&data, &fit.candidate, options.method)?;
        write_whole(path, |out| out.write_all(drawing.as_bytes()))?;
        session.remark(&format!("plot: {}", path.display()));
    }
    let source = validation.as_ref().map(|data| data.source.as_str());
    let json = schema::Fit::new(&fit, &data, source);
    let drawn = html::Recordings {
        fitted: Some(&data),
        held_out: validation.as_ref(),
    };
    report::write(session, &args.sheet, &json, drawn)?;
    session.deliver(&text::fit(&fit, &data), &json)
}
