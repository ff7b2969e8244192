//! `servoid compare`: search methods side by side on one recording.

use super::compare_runs::Header;
use super::{compare_runs, model, motor, report as page};
use crate::cli::CompareArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::compare::{self, Contest};
use servoid_engine::problem::Data;
use servoid_engine::solve;
use servoid_identify::bounded_problem;
use servoid_results::plot;
use servoid_results::report;
use servoid_results::report::html::Recordings;
use servoid_results::schema;
use std::sync::atomic::Ordering;

pub(super) fn run(session: &Session, args: &CompareArgs) -> Result<(), Error> {
    let files = [("--plot", &args.plot), ("--out", &args.out)];
    let files = files
        .into_iter()
        .filter_map(|(flag, path)| Some((flag, path.as_deref()?)));
    let outputs: Vec<_> = files.chain(page::output(&args.page)).collect();
    motor::check_outputs(session, &outputs, &args.motor, &args.recording, None)?;
    let merged = args.merge.iter();
    let merged: Vec<_> = merged.map(|path| ("a file of --merge", &**path)).collect();
    session.check_outputs(&outputs, &merged)?;
    let (recording, motor_file) = motor::recording(session, &args.motor, &args.recording)?;
    let data = Data::new(&recording)?;
    let options = model::options(&args.model, motor_file.known, session.seed, args.budget)?;
    let problem = bounded_problem(&data, &options)?;
    let names: Vec<&str> = if args.algorithm.is_empty() {
        solve::names()
    } else {
        args.algorithm.iter().map(String::as_str).collect()
    };
    let solvers: Vec<_> = names
        .iter()
        .filter_map(|name| solve::by_name(name))
        .collect();
    let mut contest = Contest {
        problem: &problem,
        budget: options.budget,
        seeds: session.seeds(args.seeds),
    };
    let rows = if args.merge.is_empty() {
        let bar = session.progress(args.seeds * solvers.len() as u64, "compare");
        let rows = compare::run(&contest, &solvers, session.stop(), &|| bar.inc(1));
        bar.finish_and_clear();
        rows
    } else {
        let header = Header::of(&contest, &names);
        let (seeds, rows) = compare_runs::merge(&args.merge, &header)?;
        contest.seeds = seeds;
        rows
    };
    // Runs that were cut short are no runs of these seeds.
    let whole = !session.stop().load(Ordering::Relaxed);
    if let Some(path) = args.out.as_deref().filter(|_| whole) {
        let header = Header::of(&contest, &names);
        compare_runs::write(path, header, &contest.seeds, &rows)?;
    }
    let json = schema::Contest::new(&contest, &rows);
    if let Some(path) = &args.plot {
        let drawing = plot::cost_curves(&json.rows, contest.budget, options.cost_name())?;
        session.write_plot(path, &drawing)?;
    }
    let text = report::text::compare(&rows, contest.budget, contest.seeds.len());
    page::write(session, &args.page, None, &json, Recordings::default())?;
    session.deliver(&text, &json)
}
