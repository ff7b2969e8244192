//! A search with a progress bar.

use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::FitProblem;
use servoid_engine::solve::{self, Found};
use servoid_identify::fit::{self, Options};

/// Searches with the method called `algorithm`; the bar shows evaluations and the best cost.
pub(super) fn search(
    session: &Session,
    problem: &FitProblem<'_>,
    algorithm: &str,
    options: &Options,
) -> Result<Found, Error> {
    let solver = solve::by_name(algorithm)
        .ok_or_else(|| Error::Usage(format!("--algorithm {algorithm}: unknown")))?;
    let bar = session.progress(options.budget as u64, "fit");
    let found = fit::search(
        problem,
        solver.as_ref(),
        options,
        session.stop(),
        &mut |count, best| {
            bar.set_position(count as u64);
            bar.set_message(format!("cost {best:.6}"));
        },
    );
    bar.finish_and_clear();
    Ok(found)
}
