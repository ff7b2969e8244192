//! What opens the bridge of an STM32 when its program cannot: the independent watchdog, the clock security system, and the
//! halt of the timer by a debugger.

use cortex_m_rt::exception;
use embassy_stm32::Peri;
use embassy_stm32::pac::iwdg::vals::Key;
use embassy_stm32::pac::{DBGMCU, IWDG as REGISTERS, RCC};
use embassy_stm32::peripherals::IWDG;
use embassy_stm32::wdg::IndependentWatchdog;
use shared::wire::Reset;

use super::{open_bridge, restart};
use crate::board::store::LONGEST_SAVE_S;

/// After this long without [`Supervision::feed`] the chip is reset, µs by the nominal 32 kHz of the watchdog's own oscillator.
/// On an F4 that is anything from 17 to 47 kHz: 5.1 to 14.1 ms. On a G4 it keeps to some 5 %. On an F1 it is nominally 40 kHz, of 30 to
/// 60: 5 to 10 ms.
///
/// The loop comes round once a millisecond. Its longest turn, while a fit is at work, takes between two and three (in the
/// emulator, with two cycles an instruction at 168 MHz).
const TIME_OUT_US: u32 = 7_500;

/// While a flash is written, at the fastest of its oscillators still [`LONGEST_SAVE_S`].
const PAUSE_US: u32 = 2 * LONGEST_SAVE_S * 1_000_000;

/// The watchdog, which nobody can stop again.
pub struct Supervision(Peri<'static, IWDG>);

impl Supervision {
    /// Begins: from the first [`feed`](Self::feed) on, each must follow the one before within the time-out. Until then it is half
    /// a second, because the counter starts full.
    pub fn begin(watchdog: Peri<'static, IWDG>) -> Self {
        watch_clock();
        halt_with_core();
        let mut begun = Self(watchdog);
        IndependentWatchdog::new(begun.0.reborrow(), TIME_OUT_US).unleash();
        begun
    }

    /// A control period has ended.
    pub fn feed(&mut self) {
        REGISTERS.kr().write(|w| w.set_key(Key::RESET));
    }

    /// The next period may end long after this one.
    pub fn pause(&mut self) {
        self.wait(PAUSE_US);
    }

    /// From now on each period must end in time again.
    pub fn resume(&mut self) {
        self.wait(TIME_OUT_US);
    }

    /// Waits for so long from now on. The watchdog takes new figures over within five turns of its oscillator.
    fn wait(&mut self, time_out_us: u32) {
        IndependentWatchdog::new(self.0.reborrow(), time_out_us);
        while REGISTERS.sr().read().0 != 0 {}
        self.feed();
    }
}

/// Lets the clock security system watch the external clock. When that stops, hardware lets the core run on from its internal
/// oscillator, raises the break of TIM1, which switches the outputs off, and interrupts the core by [`NonMaskableInt`].
fn watch_clock() {
    RCC.cr().modify(|w| w.set_csson(true));
}

/// When a debugger halts the core, the timer halts too and its outputs are off, as if by `MOE`: low, by `OSSI` (RM0090,
/// 38.16.2; RM0440, TIM1's debug mode). They come back when the core goes on, unless the watchdog was faster: that goes on
/// counting in a halt, whatever a debugger has asked for before the program began.
fn halt_with_core() {
    #[cfg(feature = "stm32f103")]
    DBGMCU.cr().modify(|w| {
        w.set_tim1(true);
        w.set_iwdg(false);
    });
    #[cfg(not(feature = "stm32f103"))]
    DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
    #[cfg(not(any(feature = "stm32f103", feature = "stm32g431")))]
    DBGMCU.apb1fzr().modify(|w| w.set_iwdg(false));
    #[cfg(feature = "stm32g431")]
    DBGMCU.apb1lfzr().modify(|w| w.set_iwdg(false));
}

/// The external clock has stopped, or the flash has an error that it cannot correct (G4).
///
/// Unsafe, as the runtime demands, because it interrupts whatever holds a lock or a mutable reference: it takes none, and
/// does not return to the interrupted code.
#[exception]
unsafe fn NonMaskableInt() -> ! {
    open_bridge();
    #[cfg(not(feature = "stm32g431"))]
    let stopped = RCC.cir().read().cssf();
    #[cfg(feature = "stm32g431")]
    let stopped = RCC.cifr().read().cssf();
    restart(if stopped {
        Reset::ClockFailure
    } else {
        Reset::HardFault
    })
}
