//! `servoid completions`: a script for the user's shell.

use crate::cli::Cli;
use crate::error::Error;
use clap::CommandFactory;

pub(super) fn run(shell: clap_complete::Shell) -> Result<(), Error> {
    clap_complete::generate(
        shell,
        &mut Cli::command(),
        "servoid",
        &mut std::io::stdout(),
    );
    Ok(())
}
