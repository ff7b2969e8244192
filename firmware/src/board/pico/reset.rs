//! Why a Pico started, and how it starts again.

use embassy_rp::pac::{PSM, WATCHDOG};
use shared::wire::Reset;

use super::chip;
use crate::board::note;

/// Why the chip started. A reset of the core alone, as debuggers do, leaves no mark: it is taken for the reset before it.
pub fn reason() -> Reset {
    let watchdog = WATCHDOG.reason().read();
    // Taken: a later reset by another's hand must not find it.
    let note = WATCHDOG.scratch0().read();
    WATCHDOG.scratch0().write_value(0);
    // The watchdog's own marks are only there if the last reset was its.
    if watchdog.force() {
        note::said(note).unwrap_or(Reset::Software)
    } else if watchdog.timer() {
        Reset::Watchdog
    } else {
        chip::reset_reason()
    }
}

/// Resets the chip, which remembers `why`. By the watchdog, because a reset of the core would leave all else as it was, the
/// watchdog's count included.
pub fn restart(why: Reset) -> ! {
    WATCHDOG.scratch0().write_value(note::word(why));
    // All but the oscillators, as `embassy-rp` has it.
    PSM.wdsel().write(|w| {
        w.0 = u32::MAX;
        w.set_rosc(false);
        w.set_xosc(false);
    });
    WATCHDOG.ctrl().write(|w| w.set_trigger(true));
    loop {
        cortex_m::asm::nop();
    }
}
