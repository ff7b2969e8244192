//! Progress of long work on a terminal.

use crate::session::Session;
use indicatif::ProgressBar;
use servoid_identify::Progress;
use std::sync::atomic::AtomicBool;

/// A bar over the evaluations of a search, or a count of the candidates of a diagnosis; stopped by Ctrl-C.
pub(super) struct Watched<'a> {
    bar: ProgressBar,
    session: &'a Session,
}

impl<'a> Watched<'a> {
    /// Of a search of at most `budget` evaluations.
    pub(super) fn search(session: &'a Session, budget: usize) -> Self {
        Watched {
            bar: session.progress(budget as u64, "fit"),
            session,
        }
    }

    /// Of a diagnosis: how many models it will fit shows only as it goes on.
    pub(super) fn diagnosis(session: &'a Session) -> Self {
        Watched {
            bar: session.count("diagnose", "models tried"),
            session,
        }
    }
}

impl Progress for Watched<'_> {
    fn evaluated(&self, evaluations: usize, cost: f64) {
        self.bar.set_position(evaluations as u64);
        self.bar.set_message(format!("cost {cost:.6}"));
    }

    fn tried(&self) {
        self.bar.inc(1);
    }

    fn stop(&self) -> &AtomicBool {
        self.session.stop()
    }
}

impl Drop for Watched<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
