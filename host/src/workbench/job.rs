//! One piece of work at a time, which the user may stop, and which stops when nobody watches any more.

use super::state::{Bench, Telling};
use crate::error::Error;
use serde_json::{Value, json};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// How often pages are told of progress, at most.
const EVERY: Duration = Duration::from_millis(40);
/// How long work goes on without a page that watches: long enough to load one again.
pub(super) const ALONE: Duration = Duration::from_secs(2);

/// What is being done.
#[derive(Default)]
pub(super) struct Job {
    running: Mutex<Option<&'static str>>,
    stop: AtomicBool,
    watching: AtomicUsize,
}

impl Job {
    /// What is being done.
    pub(super) fn running(&self) -> Option<&'static str> {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Asks the work to stop with its best so far.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }

    /// What was asked to stop has stopped; what comes after it goes on.
    pub(super) fn go_on(&self) {
        self.stop.store(false, Ordering::Relaxed);
    }

    /// The flag that searches look at.
    pub(super) fn flag(&self) -> &AtomicBool {
        &self.stop
    }

    /// Whether somebody watches.
    pub(super) fn watched(&self) -> bool {
        self.watching.load(Ordering::Relaxed) > 0
    }

    fn begin(&self, what: &'static str) -> Result<(), Error> {
        let mut running = self.running.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(other) = *running {
            return Err(Error::Usage(format!(
                "the bench is busy ({other}): wait for it, or stop it first"
            )));
        }
        *running = Some(what);
        self.stop.store(false, Ordering::Relaxed);
        Ok(())
    }

    fn end(&self) {
        *self.running.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// A page that watches the bench, for as long as it does.
pub(super) struct Watch(Arc<Bench>);

impl Watch {
    pub(super) fn new(bench: &Arc<Bench>) -> Self {
        bench.job.watching.fetch_add(1, Ordering::Relaxed);
        Watch(Arc::clone(bench))
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        self.0.job.watching.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Does `work` on a thread of its own and tells the pages how it goes.
///
/// # Errors
/// While something else is being done.
pub(super) fn start(
    bench: &Arc<Bench>,
    what: &'static str,
    work: impl FnOnce(&Arc<Bench>) -> Result<(), Error> + Send + 'static,
) -> Result<(), Error> {
    bench.job.begin(what)?;
    bench.act(|_| ());
    let own = Arc::clone(bench);
    let thread = std::thread::Builder::new().name(what.to_owned());
    let started = thread.spawn(move || {
        // A fault in one piece of work must not leave the bench busy for ever.
        let done = catch_unwind(AssertUnwindSafe(|| work(&own)));
        let stopped = own.job.stop.load(Ordering::Relaxed);
        let fault = match done {
            Ok(Ok(())) if stopped => Some(format!(
                "{what}: stopped; what had been found by then is on the bench"
            )),
            Ok(Ok(())) => None,
            // Work that is broken off has no result, whatever it makes of that.
            Ok(Err(_)) if stopped => Some(format!("{what}: stopped before there was a result")),
            Ok(Err(error)) => Some(error.to_string()),
            Err(_) => Some(format!(
                "{what} failed inside servoid; please report this with the session file"
            )),
        };
        own.job.end();
        own.change(|state| {
            if fault.is_some() {
                state.fault = fault;
            }
        });
    });
    if let Err(error) = started {
        bench.job.end();
        return Err(Error::Failed(format!("no thread for {what}: {error}")));
    }
    Ok(())
}

/// Tells pages of progress, not too often.
pub(super) struct Teller<'a> {
    bench: &'a Bench,
    last: Mutex<Option<Instant>>,
}

impl<'a> Teller<'a> {
    pub(super) fn new(bench: &'a Bench) -> Self {
        Teller {
            bench,
            last: Mutex::new(None),
        }
    }

    /// Tells `progress` unless something was told just now.
    pub(super) fn tell(&self, progress: impl FnOnce() -> Value) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_some_and(|last| last.elapsed() < EVERY) {
            return;
        }
        *last = Some(Instant::now());
        drop(last);
        let what = self.bench.job.running();
        let mut value = progress();
        value["job"] = json!(what);
        self.bench.tell(Telling::Progress(value));
    }
}
