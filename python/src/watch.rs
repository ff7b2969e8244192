//! Long work: in a thread of its own while the interpreter goes on, so that Ctrl-C stops it with the best so far.

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use servoid_identify::Progress;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How long Ctrl-C may wait.
const LOOK: Duration = Duration::from_millis(50);

/// Work that can be stopped.
#[derive(Default)]
pub(crate) struct Watched {
    stop: AtomicBool,
    ended: AtomicU64,
}

impl Watched {
    /// One more piece of the work has ended.
    pub(crate) fn count(&self) {
        self.ended.fetch_add(1, Ordering::Relaxed);
    }
}

impl Progress for Watched {
    fn stop(&self) -> &AtomicBool {
        &self.stop
    }
}

/// Does the work without the interpreter's lock. The first Ctrl-C stops it, and its best so far is the result; whoever asks for
/// it again gets the exception as soon as the work has ended.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&Watched) -> T + Send,
) -> PyResult<T> {
    counted(py, None, work)
}

/// The same; `progress`, if any, is called with how many pieces of the work have ended, now and then.
pub(crate) fn counted<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watched) -> T + Send,
) -> PyResult<T> {
    let watch = Watched::default();
    let again = AtomicBool::new(false);
    let result = py.detach(|| {
        thread::scope(|scope| {
            let (done, ended) = channel();
            let own = &watch;
            let work = scope.spawn(move || {
                let result = work(own);
                // Nobody listens any more only if the other side has panicked.
                let _ = done.send(());
                result
            });
            while ended.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
                let ended = watch.ended.load(Ordering::Relaxed);
                let interrupted = Python::attach(|py| {
                    // First: Python's code that runs here would take the signal for itself.
                    let stopped = py.check_signals().is_err();
                    match progress.map(|progress| progress.call1(py, (ended,))) {
                        Some(Err(error)) if error.is_instance_of::<PyKeyboardInterrupt>(py) => true,
                        Some(Err(error)) => {
                            // It shows how far the work is, and must not end it.
                            error.write_unraisable(py, None);
                            stopped
                        }
                        _ => stopped,
                    }
                });
                if interrupted && watch.stop.swap(true, Ordering::Relaxed) {
                    again.store(true, Ordering::Relaxed);
                }
            }
            work.join()
        })
    });
    if again.into_inner() {
        return Err(PyKeyboardInterrupt::new_err(()));
    }
    result.map_err(|_| {
        super::error::raised(
            "internal",
            "the work failed inside servoid; please report this",
        )
    })
}
