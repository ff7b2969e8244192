//! `servoid fit`: a model of one recording.

use super::{model, motor};
use crate::cli::FitArgs;
use crate::error::Error;
use crate::fit::{self, Fit};
use crate::output::write_whole;
use crate::plot;
use crate::problem::Data;
use crate::report;
use crate::session::Session;
use crate::solve;

pub(super) fn run(session: &Session, args: &FitArgs) -> Result<(), Error> {
    check_outputs(session, args)?;
    let (recording, motor_file) = motor::recording(&args.motor, &args.recording)?;
    let data = Data::new(&recording)?;
    let validation = match &args.validate {
        Some(path) => Some(Data::new(&motor::recording(&args.motor, path)?.0)?),
        None => None,
    };
    let options = model::options(&args.model, motor_file.known, session.seed, args.budget)?;
    let solver = solve::by_name(&args.algorithm)
        .ok_or_else(|| Error::Usage(format!("--algorithm {}: unknown", args.algorithm)))?;
    let mut problem = fit::problem(&data, &options)?;
    model::apply_bounds(&mut problem, &args.model.bounds)?;

    let bar = session.progress(args.budget, "fit");
    let found = fit::search(
        &problem,
        solver.as_ref(),
        &options,
        session.stop(),
        &mut |count, best| {
            bar.set_position(count as u64);
            bar.set_message(format!("cost {best:.6}"));
        },
    );
    bar.finish_and_clear();
    let cost_kind = args.model.cost.name();
    let fit = Fit::conclude(
        &problem,
        &args.algorithm,
        cost_kind,
        &found,
        &options,
        validation.as_ref(),
    )?;
    if let Some(path) = &args.plot {
        let drawing = plot::overlay(&data, &fit.candidate, options.method)?;
        write_whole(path, |out| out.write_all(drawing.as_bytes()))?;
        session.remark(&format!("plot: {}", path.display()));
    }
    session.deliver(
        &report::text::fit(&fit, &data),
        &report::json::FitJson::from(&fit),
    )
}

/// The results must not replace what the fit reads.
fn check_outputs(session: &Session, args: &FitArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    let motor = motor::motor_path(&args.motor, &args.recording);
    let mut inputs = vec![("the recording", args.recording.as_path())];
    inputs.extend(
        args.validate
            .as_deref()
            .map(|path| ("the --validate recording", path)),
    );
    inputs.push(("the motor file", &motor));
    session.check_outputs(plot.as_slice(), &inputs)
}
