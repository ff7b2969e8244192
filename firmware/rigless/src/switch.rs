//! The power switch of a bench: a line on the standard input cuts the power for a moment.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

/// The switch.
#[derive(Debug, Clone, Default)]
pub struct PowerSwitch(Arc<AtomicBool>);

impl PowerSwitch {
    /// Watches the standard input to its end.
    pub fn watch() -> Self {
        let switch = PowerSwitch::default();
        let cut = switch.clone();
        thread::spawn(move || {
            for _line in io::stdin().lines().map_while(Result::ok) {
                cut.0.store(true, Ordering::Relaxed);
            }
        });
        switch
    }

    /// Whether somebody has cut the power since this was asked last.
    pub fn was_cut(&self) -> bool {
        self.0.swap(false, Ordering::Relaxed)
    }
}
