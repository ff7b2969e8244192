//! `servoid completions`: a script for the user's shell.

use crate::cli::Cli;
use crate::error::Error;
use crate::session::print;
use clap::CommandFactory;

pub(super) fn run(shell: clap_complete::Shell) -> Result<(), Error> {
    // Into memory first: the generator panics where its writer fails, as stdout may.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "servoid", &mut script);
    print(&script)
}
