//! How long work tells of itself, and how it is stopped.

use std::sync::atomic::AtomicBool;

/// What watches a fit or a diagnosis. Every method may be called from several threads.
pub trait Progress: Sync {
    /// A search has evaluated so many models; `cost` is the least so far.
    fn evaluated(&self, _evaluations: usize, _cost: f64) {}

    /// A diagnosis has fitted one more candidate.
    fn tried(&self) {}

    /// Set it to stop: the work ends soon, with the best so far.
    fn stop(&self) -> &AtomicBool;
}

/// Nobody watches, and nobody stops the work.
#[derive(Debug, Default)]
pub struct Silent {
    stop: AtomicBool,
}

impl Progress for Silent {
    fn stop(&self) -> &AtomicBool {
        &self.stop
    }
}
