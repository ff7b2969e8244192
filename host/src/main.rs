//! The command line `servoid`: parses, dispatches, and turns an error into a message and an exit code.
#![forbid(unsafe_code)]

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use host::cli::Cli;
use servoid_io::input::Part;
use servoid_io::input::suggest::nearest;
use servoid_results::report::style::{BAD, painted};
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    match host::cmd::run(parsed(std::env::args_os().collect())) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            anstream::eprintln!("{}: {error}", painted(BAD.bold(), "servoid"));
            ExitCode::from(error.exit_code())
        }
    }
}

/// The command line. A log in the place of a verb opens the workbench with it; a verb that is misspelt is told from those that there are.
fn parsed(mut words: Vec<OsString>) -> Cli {
    let error = match Cli::try_parse_from(&words) {
        Ok(cli) => return cli,
        Err(error) => error,
    };
    let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(word))) =
        (error.kind(), error.get(ContextKind::InvalidSubcommand))
    else {
        error.exit()
    };
    let place = words.iter().position(|own| own.to_str() == Some(word));
    if let Some(place) = place.filter(|_| Part::of(Path::new(word)).path.exists()) {
        words.insert(place, "bench".into());
        return Cli::parse_from(words);
    }
    let command = <Cli as clap::CommandFactory>::command();
    let verbs = command.get_subcommands().map(clap::Command::get_name);
    let name = painted(BAD.bold(), "servoid");
    match nearest(word, verbs) {
        Some(near) => anstream::eprintln!(
            "{name}: no verb is called `{word}`; did you mean `servoid {near}`?"
        ),
        None => anstream::eprintln!(
            "{name}: no verb and no file is called `{word}`; `servoid --help` lists the verbs, and `servoid LOG` opens a log"
        ),
    }
    std::process::exit(2)
}
