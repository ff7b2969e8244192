//! `servoid fit`: a model of one recording.

use super::progress::Watched;
use super::{model, motor, report};
use crate::cli::FitArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_identify::FitSets;
use servoid_identify::fit::Options;
use servoid_results::plot;
use servoid_results::report::{html, text};
use servoid_results::schema;

pub(super) fn run(session: &Session, args: &FitArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    let outputs: Vec<_> = plot.into_iter().chain(report::output(&args.page)).collect();
    let read = motor::read(session, &outputs, &args.motor, &args.recordings)?;
    let sets = FitSets::of_several(read.fitted, read.held_out, args.force)?;
    for remark in &sets.remarks {
        session.remark(remark);
    }
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
    let fit = sets.identify(&options, &watched)?;
    drop(watched);
    let (data, held_out) = (&sets.fitted, sets.held_out.as_ref());
    if let Some(path) = &args.plot {
        let drawing = plot::overlay(data, &fit.candidate, options.method)?;
        session.write_plot(path, &drawing)?;
    }
    let source = held_out.map(|data| data.source.as_str());
    let json = schema::Fit {
        read: Some(read.how),
        ..schema::Fit::new(&fit, data, source)
    };
    let drawn = html::Recordings {
        fitted: Some(data),
        held_out,
    };
    report::write(
        session,
        &args.page,
        read.motor.name.as_deref(),
        &json,
        drawn,
    )?;
    session.deliver(&text::fit(&fit, data), &json)
}
