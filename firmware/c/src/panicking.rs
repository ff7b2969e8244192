//! What happens where this library has an error of its own.

use core::panic::PanicInfo;

unsafe extern "C" {
    /// The firmware's own: opens the bridge and does not return.
    safe fn servoid_panicked() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    servoid_panicked()
}
