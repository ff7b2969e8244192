//! Progress of long work on a terminal.

use crate::session::Session;
use indicatif::ProgressBar;
use servoid_identify::Progress;
use servoid_io::input::Reached;
use std::cell::OnceCell;
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

/// Steps of the bar of a file.
const PARTS: u64 = 100;

/// A bar over a file that is read, or a count of its rows where nobody knows how many there will be.
pub(super) struct FileBar<'s> {
    session: &'s Session,
    what: &'static str,
    /// Which of both shows with the first rows.
    bar: OnceCell<ProgressBar>,
}

impl<'s> FileBar<'s> {
    pub(super) fn new(session: &'s Session, what: &'static str) -> Self {
        FileBar {
            session,
            what,
            bar: OnceCell::new(),
        }
    }

    pub(super) fn reached(&self, reached: Reached) {
        let bar = self.bar.get_or_init(|| match reached.part {
            Some(_) => self.session.progress(PARTS, self.what),
            None => self.session.count(self.what, "rows"),
        });
        match reached.part {
            Some(part) => {
                bar.set_position((part * PARTS as f64) as u64);
                bar.set_message(format!("{} rows", reached.rows));
            }
            None => bar.set_position(reached.rows),
        }
    }
}

impl Drop for FileBar<'_> {
    fn drop(&mut self) {
        if let Some(bar) = self.bar.get() {
            bar.finish_and_clear();
        }
    }
}

impl Drop for Watched<'_> {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
