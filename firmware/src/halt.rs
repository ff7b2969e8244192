//! Handles a fatal error: opens the bridge, then resets the microcontroller, which
//! leaves the bridge open until a host asks for a drive again. The next start knows why.

use core::panic::PanicInfo;

#[cfg(feature = "cortex-m")]
use cortex_m_rt::{ExceptionFrame, exception};
use shared::wire::Reset;

use crate::board::{open_bridge, restart};
use crate::log;

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    open_bridge();
    log::panicked(info);
    restart(Reset::Panic)
}

/// A fault of the processor (on an ESP32-C6 it is a panic): memory that is not there, an instruction that does not exist, a stack that has run over.
///
/// Unsafe, as the runtime demands, because it interrupts whatever holds a lock or a mutable reference: it takes none, and
/// does not return to the interrupted code.
#[cfg(feature = "cortex-m")]
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    open_bridge();
    log::crashed(frame.pc(), frame.lr());
    restart(Reset::HardFault)
}
