//! The command line `servoid`: parses, dispatches, and turns an error into a message and an exit code.
#![forbid(unsafe_code)]

use clap::Parser;
use host::cli::Cli;
use servoid_results::report::style::{BAD, painted};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = Cli::parse();
    match host::cmd::run(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            anstream::eprintln!("{}: {error}", painted(BAD.bold(), "servoid"));
            ExitCode::from(error.exit_code())
        }
    }
}
