//! `servoid open`: what a log holds, drawn if asked for, and the command that would fit it.

use super::motor;
use super::progress::FileBar;
use crate::cli::{MotorArgs, OpenArgs};
use crate::error::Error;
use crate::session::Session;
use servoid_io::input::{Proposal, for_shell, survey};
use servoid_results::plot;
use servoid_results::report::opened::text;
use servoid_results::schema::opened::Opened;

pub(super) fn run(session: &Session, args: &OpenArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    motor::check_outputs(session, plot.as_slice(), &args.motor, &args.log, None)?;
    let motor = motor::motor_file(&args.motor, &args.log)?;
    let bar = FileBar::new(session, "open");
    let survey = survey(&args.log, &motor, None, &|reached| bar.reached(reached))?;
    drop(bar);
    if let Some(path) = &args.plot {
        let name = args.log.file_name().unwrap_or(args.log.as_os_str());
        let drawing = plot::columns(&name.to_string_lossy(), &survey)?;
        session.write_plot(path, &drawing)?;
    }
    let file = args.log.display().to_string();
    let (command, needs) = fitting(&file, &survey.proposal, &given(&args.motor));
    let opened = Opened::new(&file, &survey, command, needs);
    session.deliver(&text(&opened), &opened)
}

/// The command that would fit the log, and what it still needs.
fn fitting(file: &str, proposal: &Proposal, given: &[String]) -> (String, Vec<String>) {
    let mut words = vec!["servoid fit".to_owned(), for_shell(file)];
    words.extend_from_slice(given);
    words.extend(
        proposal
            .options()
            .into_iter()
            .filter(|own| !given.contains(own)),
    );
    words.extend(proposal.needs.iter().map(|need| need.option.clone()));
    let needs = proposal.needs.iter().map(|need| need.text.clone());
    (
        words.join(" "),
        needs.chain(proposal.doubts.iter().cloned()).collect(),
    )
}

/// What the user has said by flags, to stand in the command as well.
fn given(args: &MotorArgs) -> Vec<String> {
    let texts = |flag: &str, values: &[String]| -> Vec<String> {
        let each = values.iter();
        each.map(|value| format!("{flag} {}", for_shell(value)))
            .collect()
    };
    let number = |flag: &str, value: Option<f64>| value.map(|value| format!("{flag} {value}"));
    let mut words = [
        texts("--column", &args.column),
        texts("--unit", &args.unit),
        texts("--drive", args.drive.as_slice()),
        texts("--table", args.table.as_slice()),
        texts("--select", &args.select),
    ]
    .concat();
    let motor = args.motor.as_ref();
    words.extend(motor.map(|path| format!("--motor {}", for_shell(&path.display().to_string()))));
    words.extend(number("--counts-per-rev", args.counts_per_rev));
    words.extend(number("--supply-v", args.supply));
    words.extend(number("--metres-per-rev", args.metres_per_rev));
    words.extend(number("--rate", args.rate));
    words.extend(number("--from", args.from));
    words.extend(number("--to", args.to));
    words
}
