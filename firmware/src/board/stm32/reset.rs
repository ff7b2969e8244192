//! Why an STM32 started, and how it starts again.

use core::ptr;

use cortex_m::peripheral::SCB;
use embassy_stm32::pac::RCC;
use shared::wire::Reset;

use crate::board::note;

/// The note to the next start. `.uninit` is RAM that the runtime leaves as it finds it.
// Safety: the name of the section is all that is unsafe about it; cortex-m-rt's linker script reserves it in RAM.
#[unsafe(link_section = ".uninit.reset_note")]
static mut NOTE: u32 = 0;

/// Why the chip started. Once: it forgets that here, so that the next reset is not taken for this one.
pub fn reason() -> Reset {
    let flags = RCC.csr().read();
    RCC.csr().modify(|w| w.set_rmvf(true));
    // Every reset pulls the pin, and power-up leaves the mark of a brown-out as well: so the order matters. The G4 has no mark
    // of power-up but that.
    #[cfg(not(any(feature = "stm32f103", feature = "stm32g431")))]
    let (watchdog, pin, up) = (flags.wdgrstf(), flags.padrstf(), flags.porrstf());
    #[cfg(feature = "stm32f103")]
    let (watchdog, pin, up) = (flags.iwdgrstf(), flags.pinrstf(), flags.porrstf());
    #[cfg(feature = "stm32g431")]
    let (watchdog, pin, up) = (flags.iwdgrstf(), flags.pinrstf(), flags.borrstf());
    // The F1 takes a brown-out for power-up.
    #[cfg(feature = "stm32f103")]
    let brown_out = false;
    #[cfg(not(feature = "stm32f103"))]
    let brown_out = flags.borrstf();
    if watchdog {
        Reset::Watchdog
    } else if flags.sftrstf() {
        note::said(read_note()).unwrap_or(Reset::Software)
    } else if up {
        Reset::PowerUp
    } else if brown_out {
        Reset::BrownOut
    } else if pin {
        Reset::Pin
    } else {
        Reset::Unknown
    }
}

/// Resets the chip, which remembers `why`.
pub fn restart(why: Reset) -> ! {
    write_note(note::word(why));
    SCB::sys_reset()
}

/// Takes the note: a later reset by a debugger must not find it.
fn read_note() -> u32 {
    // Safety: the address is that of an aligned `u32` of our own, for which all bits are valid. Volatile, because what is
    // read there was written before this program began.
    let word = unsafe { ptr::read_volatile(&raw const NOTE) };
    write_note(0);
    word
}

fn write_note(word: u32) {
    // Safety: as above. It is written here only, before the board is put together and when nothing else runs any more; no
    // reference to it is ever made.
    unsafe {
        ptr::write_volatile(&raw mut NOTE, word);
    }
}
