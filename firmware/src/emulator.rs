//! Ends a program in an emulator with an exit code, by semihosting. A panic is a failure.

use core::panic::PanicInfo;

use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};

/// Ends the emulation.
pub fn end(succeeded: bool) -> ! {
    exit(if succeeded {
        EXIT_SUCCESS
    } else {
        EXIT_FAILURE
    });
    loop {}
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    end(false)
}
