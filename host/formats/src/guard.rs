//! Crates that check most of what they read, and panic at the rest.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether this thread reads foreign bytes.
    static READING: Cell<bool> = const { Cell::new(false) };
}

/// What `read` makes of foreign bytes; `None` where it panics, which is no reason to end the program. Nothing is printed then: the
/// user gets an error with the file's name.
///
/// What `read` has changed must not be used after that.
pub(crate) fn guarded<T>(read: impl FnOnce() -> T) -> Option<T> {
    static SILENT: Once = Once::new();
    SILENT.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !READING.get() {
                before(panic);
            }
        }));
    });
    let outer = READING.replace(true);
    let outcome = catch_unwind(AssertUnwindSafe(read));
    READING.set(outer);
    outcome.ok()
}
