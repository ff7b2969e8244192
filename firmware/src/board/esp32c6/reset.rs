//! Why an ESP32-C6 started, and how it starts again.

use esp_hal::ram;
use esp_hal::rtc_cntl::SocResetReason as Why;
use portable_atomic::{AtomicU32, Ordering};
use shared::wire::Reset;

use crate::board::note;

/// The note to the next start, in memory that a reset by software leaves as it is.
#[ram(unstable(rtc_fast, persistent))]
static NOTE: AtomicU32 = AtomicU32::new(0);

/// Why the chip started. The pin that resets it leaves the mark of power-up.
pub fn reason() -> Reset {
    // Taken: a later reset by another's hand must not find it.
    let note = NOTE.load(Ordering::Relaxed);
    NOTE.store(0, Ordering::Relaxed);
    match esp_hal::system::reset_reason() {
        Some(Why::CoreMwdt0 | Why::CoreMwdt1 | Why::Cpu0Mwdt0 | Why::Cpu0Mwdt1) => Reset::Watchdog,
        Some(Why::CoreSw | Why::Cpu0Sw) => note::said(note).unwrap_or(Reset::Software),
        Some(Why::ChipPowerOn) => Reset::PowerUp,
        Some(Why::SysBrownOut) => Reset::BrownOut,
        _ => Reset::Unknown,
    }
}

/// Resets the chip, which remembers `why`.
pub fn restart(why: Reset) -> ! {
    NOTE.store(note::word(why), Ordering::Relaxed);
    esp_hal::system::software_reset()
}
