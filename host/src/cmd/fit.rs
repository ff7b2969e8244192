//! `servoid fit`: a model of one recording.

use super::progress::Watched;
use super::{model, motor, report};
use crate::cli::FitArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_identify::fit::Options;
use servoid_identify::{check, identify_data};
use servoid_io::recording::Recording;
use servoid_results::plot;
use servoid_results::report::{html, text};
use servoid_results::schema;

pub(super) fn run(session: &Session, args: &FitArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    let outputs: Vec<_> = plot.into_iter().chain(report::output(&args.page)).collect();
    let read = motor::read(session, &outputs, &args.motor, &args.recordings)?;
    for recording in &read.fitted {
        for finding in check::passed(recording, args.force)? {
            session.remark(&finding.text());
        }
    }
    let held_out = read.held_out.len();
    let copied = |other: &Recording| read.fitted.iter().any(|one| one.is_copy_of(other));
    let others: Vec<Recording> = (read.held_out.iter().filter(|other| !copied(other)))
        .cloned()
        .collect();
    if others.len() < held_out {
        session.remark("--validate is the recording itself: nothing is held out; give another recording of the same motor");
    }
    let validation = match others.is_empty() {
        true => None,
        false => Some(joined(others)?),
    };
    let data = joined(read.fitted)?;
    let options = Options {
        algorithm: args.algorithm.clone(),
        error_ladder: true,
        force: args.force,
        own: args.own.clone(),
        certificate: args.certificate,
        profile: args.profile,
        ..model::options(&args.model, read.motor.known, session.seed, args.budget)?
    };
    let watched = Watched::search(session, options.budget);
    let fit = identify_data(&data, validation.as_ref(), &options, &watched)?;
    drop(watched);
    if let Some(path) = &args.plot {
        let drawing = plot::overlay(&data, &fit.candidate, options.method)?;
        session.write_plot(path, &drawing)?;
    }
    let source = validation.as_ref().map(|data| data.source.as_str());
    let json = schema::Fit::new(&fit, &data, source);
    let drawn = html::Recordings {
        fitted: Some(&data),
        held_out: validation.as_ref(),
    };
    report::write(
        session,
        &args.page,
        read.motor.name.as_deref(),
        &json,
        drawn,
    )?;
    session.deliver(&text::fit(&fit, &data), &json)
}

fn joined(recordings: Vec<Recording>) -> Result<Data, Error> {
    Ok(Data::joined(recordings).map_err(servoid_identify::Error::from)?)
}
