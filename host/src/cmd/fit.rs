//! `servoid fit`: a model of one recording.

use super::search::search;
use super::{model, motor, report};
use crate::cli::FitArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::{Data, FitProblem};
use servoid_engine::solve::Found;
use servoid_identify::diagnose::{self, Effort};
use servoid_identify::fit::{self, Fit, Options};
use servoid_io::output::write_whole;
use servoid_results::plot;
use servoid_results::report::{html, text};
use servoid_results::schema;
use shared::cost::Cost;

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
    let data = Data::taken(recording)?;
    let validation = match &args.validate {
        Some(path) => Some(Data::taken(motor::recording(&args.motor, path)?.0)?),
        None => None,
    };
    let options = model::options(&args.model, motor_file.known, session.seed, args.budget)?;
    let mut problem = fit::problem(&data, &options)?;
    model::apply_bounds(&mut problem, &args.model.bounds)?;

    let mut found = search(session, &problem, &args.algorithm, &options)?;
    if args.algorithm == "lm"
        && let Some((again, better)) = again(session, &problem, &found, &options)
    {
        problem = again;
        found = better;
    }
    let cost_kind = args.model.cost.name();
    let mut fit = Fit::conclude(
        &problem,
        &args.algorithm,
        cost_kind,
        &found,
        &options,
        validation.as_ref(),
    )?;
    if !options.effects.is_empty() {
        let stop = session.stop();
        fit.ladder = fit::ladder(&data, validation.as_ref(), &fit, &options, stop);
    }
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

/// Least squares begun once more, from where the effects lead that are added one by one: from regression it may have ended
/// in the wrong valley. `None` where that was not needed, or led nowhere better.
fn again<'a>(
    session: &Session,
    problem: &FitProblem<'a>,
    found: &Found,
    options: &Options,
) -> Option<(FitProblem<'a>, Found)> {
    let squares = problem.cost == Cost::Squared;
    if !squares || found.interrupted || !diagnose::is_lost(found.cost, problem.data.len()) {
        return None;
    }
    let effort = Effort::usual(session.stop());
    let candidate = diagnose::built_up(problem.data, &options.effects, options, &effort)?;
    let again = problem.begun_at(&candidate);
    let better = search(session, &again, "lm", options).ok()?;
    (better.cost < found.cost).then_some((again, better))
}
