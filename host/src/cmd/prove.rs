//! `servoid prove`: random cases from the virtual bench, diagnosed blind.

use crate::cli::ProveArgs;
use crate::error::Error;
use crate::prove::{self, Outcome, SetUp, tally};
use crate::session::Session;

pub(super) fn run(session: &Session, args: &ProveArgs) -> Result<(), Error> {
    let set_up = SetUp {
        seed: session.seed,
        hidden: args.hidden,
        excite: args.excite,
        effects: args.effect.clone(),
    };
    session.check_outputs(&[], &[])?;
    let numbers: Vec<u64> = (0..args.cases).collect();
    let bar = session.progress(args.cases, "prove");
    let mut outcomes: Vec<Outcome> = Vec::new();
    prove::run(&set_up, &numbers, session.stop(), &mut |outcome| {
        outcomes.push(outcome);
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    outcomes.sort_by_key(|outcome| outcome.case);
    session.deliver(&tally::text(&outcomes), &outcomes)
}
