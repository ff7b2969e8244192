//! The control period of a Cortex-M core: its own timer, the core asleep until the period ends.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::{SYST, syst::SystClkSource};
use cortex_m_rt::exception;

use super::generic::Tick;
use crate::phase::Fault;

/// Periods that have ended since the start; wraps around.
static ENDED: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    // Not `fetch_add`, which the M0+ does not have: nothing else writes.
    ENDED.store(
        ENDED.load(Ordering::Relaxed).wrapping_add(1),
        Ordering::Relaxed,
    );
}

/// Ends of control periods, one after another.
#[derive(Debug)]
pub struct Period {
    seen: u32,
}

impl Period {
    /// Lets periods of `cycles` core clocks begin. A carrier whose period divides them keeps its phase in the control
    /// period, so that its ripple looks the same in every sample.
    pub fn new(mut timer: SYST, cycles: u32) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(cycles - 1);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        Self {
            seen: ENDED.load(Ordering::Relaxed),
        }
    }
}

impl Tick for Period {
    /// Time since the start, scrambled but for a core cycle: differs between two events that nobody synchronised.
    fn time(&self) -> u32 {
        ENDED.load(Ordering::Relaxed).rotate_left(16) ^ SYST::get_current()
    }

    /// Sleeps until the period ends.
    ///
    /// # Errors
    ///
    /// [`Fault::Overrun`], at once, if it had ended before.
    fn end(&mut self) -> Result<(), Fault> {
        let ended = ENDED.load(Ordering::Relaxed);
        if ended != self.seen {
            self.seen = ended;
            return Err(Fault::Overrun);
        }
        while ENDED.load(Ordering::Relaxed) == self.seen {
            // With interrupts masked an interrupt still ends the sleep, but cannot slip in between the check and the
            // sleep and leave the core asleep for a period too long.
            cortex_m::interrupt::free(|_| {
                if ENDED.load(Ordering::Relaxed) == self.seen {
                    cortex_m::asm::wfi();
                }
            });
        }
        self.seen = self.seen.wrapping_add(1);
        Ok(())
    }
}
