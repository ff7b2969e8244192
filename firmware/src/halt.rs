//! Handles a fatal error: opens the bridge, then resets the microcontroller, which
//! leaves the bridge open until a host asks for a drive again.

use core::panic::PanicInfo;

use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};

use crate::board::open_bridge;

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    halt()
}

/// A fault of the processor: memory that is not there, an instruction that does not exist, a stack that has run over.
///
/// Unsafe, as the runtime demands, because it interrupts whatever holds a lock or a mutable reference: it takes none, and
/// does not return to the interrupted code.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    halt()
}

fn halt() -> ! {
    open_bridge();
    SCB::sys_reset()
}
