//! How much a diagnosis may compute. It is counted in steps of a model, not in seconds, and looked at between
//! pieces of work that do not run side by side: so a diagnosis ends at the same place on every machine.

use super::settings::SEARCH;
pub use super::settings::USUAL_STEPS;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// What a diagnosis may compute, and what it has computed.
pub struct Budget<'a> {
    stop: &'a AtomicBool,
    most: u64,
    spent: AtomicU64,
    /// Whether what is being done now has to end.
    over: AtomicBool,
    ran_out: AtomicBool,
    searches: AtomicBool,
}

impl<'a> Budget<'a> {
    /// The usual number of steps, until `stop` is set.
    pub fn usual(stop: &'a AtomicBool) -> Self {
        Budget::of(USUAL_STEPS, stop)
    }

    /// So many steps, until `stop` is set.
    pub fn of(most: u64, stop: &'a AtomicBool) -> Self {
        Budget {
            stop,
            most,
            spent: AtomicU64::new(0),
            over: AtomicBool::new(false),
            ran_out: AtomicBool::new(false),
            searches: AtomicBool::new(true),
        }
    }

    /// As many steps once more, until the same flag is set.
    pub fn again(&self) -> Self {
        Budget::of(self.most, self.stop)
    }

    /// Steps that were taken.
    pub fn spent(&self) -> u64 {
        self.spent.load(Ordering::Relaxed)
    }

    /// Steps that may be taken.
    pub fn most(&self) -> u64 {
        self.most
    }

    /// Whether the steps did not suffice.
    pub fn ran_out(&self) -> bool {
        self.ran_out.load(Ordering::Relaxed)
    }

    /// The flag that the user sets.
    pub fn stop(&self) -> &'a AtomicBool {
        self.stop
    }

    /// Whether work has to end with what it has.
    pub(in crate::diagnose) fn exhausted(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.over.load(Ordering::Relaxed)
    }

    /// Books steps that were taken.
    pub(in crate::diagnose) fn book(&self, steps: u64) {
        self.spent.fetch_add(steps, Ordering::Relaxed);
    }

    /// Compares what was spent with what may be. To be called where no work is under way.
    pub(in crate::diagnose) fn checkpoint(&self) {
        let part = if self.searches.load(Ordering::Relaxed) {
            SEARCH
        } else {
            1.0
        };
        if self.spent() as f64 >= part * self.most as f64 {
            self.over.store(true, Ordering::Relaxed);
            self.ran_out.store(true, Ordering::Relaxed);
        }
    }

    /// Ends the search for effects: what was kept back for it may now be spent on trying the best model.
    pub(in crate::diagnose) fn release_reserve(&self) {
        self.searches.store(false, Ordering::Relaxed);
        self.over.store(false, Ordering::Relaxed);
        self.checkpoint();
    }
}
