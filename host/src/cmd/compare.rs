//! `servoid compare`: search methods side by side on one recording.

use super::{model, motor, report as page};
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

pub(super) fn run(session: &Session, args: &CompareArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    let outputs: Vec<_> = plot.into_iter().chain(page::output(&args.page)).collect();
    motor::check_outputs(session, &outputs, &args.motor, &args.recording, None)?;
    let (recording, motor_file) = motor::recording(&args.motor, &args.recording)?;
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
    let contest = Contest {
        problem: &problem,
        budget: options.budget,
        seeds: session.seeds(args.seeds),
    };
    let bar = session.progress(args.seeds * solvers.len() as u64, "compare");
    let rows = compare::run(&contest, &solvers, session.stop(), &|| bar.inc(1));
    bar.finish_and_clear();
    let json = schema::Contest::new(&contest, &rows);
    if let Some(path) = &args.plot {
        let drawing = plot::cost_curves(&json.rows, contest.budget, options.cost_name())?;
        session.write_plot(path, &drawing)?;
    }
    let text = report::text::compare(&rows, contest.budget, contest.seeds.len());
    page::write(session, &args.page, None, &json, Recordings::default())?;
    session.deliver(&text, &json)
}
