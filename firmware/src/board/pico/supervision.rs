//! Opens the bridge of a Pico when its program cannot: the chip's watchdog resets it, which lets go of the enable pin, and a
//! resistor pulls that low.
//!
//! The watchdog counts microseconds of the crystal, and this chip has nothing that would notice if the crystal stopped. The
//! PLL behind it then slows down to a speed of its own: the program may go on, slowly, and no bound can be given.

use embassy_rp::Peri;
use embassy_rp::peripherals::WATCHDOG;
use embassy_rp::watchdog::Watchdog;
use embassy_time::Duration;

use super::bridge_is_closed;
use crate::board::generic::Tick;
use crate::board::period::Period;
use crate::phase::Fault;

/// After this long without the end of a control period the chip is reset.
///
/// The loop comes round once a millisecond. Its longest turns, in which a fit builds a model, take seven (in the emulator, which
/// knows no misses of the flash's cache).
const TIME_OUT: Duration = Duration::from_millis(15);

/// Control periods, each of which feeds the watchdog.
pub struct Supervised {
    period: Period,
    watchdog: Watchdog,
}

impl Supervised {
    /// From now on each period must end within the time-out.
    pub fn begin(period: Period, watchdog: Peri<'static, WATCHDOG>) -> Self {
        let mut watchdog = Watchdog::new(watchdog);
        watchdog.start(TIME_OUT);
        Self { period, watchdog }
    }
}

impl Tick for Supervised {
    fn end(&mut self) -> Result<(), Fault> {
        let ended = self.period.end();
        self.watchdog.feed(TIME_OUT);
        // The PWM goes on while a debugger halts the core, and so must the watchdog. With the bridge open it waits: it would
        // reset the chip under the hands of whoever flashes it.
        self.watchdog.pause_on_debug(!bridge_is_closed());
        ended
    }

    fn pause(&mut self, seconds: u32) {
        self.watchdog.feed(Duration::from_secs(seconds.into()));
    }

    fn time(&self) -> u32 {
        self.period.time()
    }
}
