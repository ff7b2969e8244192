//! One verb a file: read, call, write.

mod batch;
mod bench;
mod check;
mod compare;
mod compare_runs;
mod completions;
mod demo;
mod device;
mod diagnose;
mod effects;
mod export;
mod fit;
mod fleet;
mod formula;
mod model;
mod motor;
mod motor_beside;
mod open;
mod paper;
mod plan;
mod progress;
mod prove;
mod report;
mod simulate;
mod simulate_list;

use crate::cli::{Cli, Verb};
use crate::error::Error;
use crate::session::Session;

/// Runs the verb.
///
/// # Errors
/// Whatever went wrong, with its remedy.
pub fn run(cli: Cli) -> Result<(), Error> {
    let session = Session::new(&cli.common)?;
    match cli.verb {
        Verb::Demo(args) => demo::run(&session, &args),
        Verb::Simulate(args) => simulate::run(&session, &args),
        Verb::Diagnose(args) => diagnose::run(&session, &args),
        Verb::Open(args) => open::run(&session, &args),
        Verb::Check(args) => check::run(&session, &args),
        Verb::Fit(args) => fit::run(&session, &args),
        Verb::Export(args) => export::run(&session, &args),
        Verb::Compare(args) => compare::run(&session, &args),
        Verb::Paper(args) => paper::run(&session, &args),
        Verb::Batch(args) => batch::run(&session, &args),
        Verb::Fleet(args) => fleet::fleet(&session, &args),
        Verb::Population(args) => fleet::population(&session, &args),
        Verb::Draw(args) => fleet::draw(&session, &args),
        Verb::Bench(args) => bench::run(&session, &args),
        Verb::Report(args) => report::run(&session, &args),
        Verb::Prove(args) => prove::run(&session, &args),
        Verb::Device(args) => device::run(&session, &args),
        Verb::Effects(args) => effects::run(&session, &args),
        Verb::Completions { shell } => completions::run(shell),
    }
}
