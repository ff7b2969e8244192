//! Control periods by the system timer, and the watchdog that opens the bridge of a program that does not come back.

use esp_hal::peripherals::TIMG0;
use esp_hal::time::Duration;
use esp_hal::timer::systimer::{SystemTimer, Unit};
use esp_hal::timer::timg::{MwdtStage, Wdt};

use crate::board::generic::{Tick, Turn};
use crate::phase::Fault;

/// Ticks of the system timer in a control period: 16 MHz off the crystal, as the carrier's clock is.
const PERIOD: u64 = 16_000;
/// From the end of a control period to the carrier's turn: as long as half a carrier, in which the program gives the next duty.
const BEFORE_TURN: u64 = 400;
/// After this long without the end of a control period the chip is reset, which lets go of the enable pin. The watchdog counts by the
/// crystal too: nothing here notices when that stops.
const TIME_OUT: Duration = Duration::from_millis(15);

/// The clock.
pub struct Clock {
    ends: u64,
    watchdog: Wdt<TIMG0<'static>>,
}

fn now() -> u64 {
    SystemTimer::unit_value(Unit::Unit0)
}

impl Clock {
    /// Lets control periods begin, in step with the carrier. From now on each must end within the time-out.
    pub fn begin(mut watchdog: Wdt<TIMG0<'static>>, carrier: &mut impl Turn) -> Self {
        carrier.begin();
        carrier.wait();
        let ends = now() + PERIOD - BEFORE_TURN;
        watchdog.set_timeout(MwdtStage::Stage0, TIME_OUT);
        watchdog.enable();
        Self { ends, watchdog }
    }
}

impl Tick for Clock {
    fn end(&mut self) -> Result<(), Fault> {
        self.watchdog.feed();
        let late = now() >= self.ends;
        while now() < self.ends {}
        // A period that was missed keeps the next ones in step.
        while self.ends <= now() {
            self.ends += PERIOD;
        }
        if late { Err(Fault::Overrun) } else { Ok(()) }
    }

    fn time(&self) -> u32 {
        now() as u32
    }
}
