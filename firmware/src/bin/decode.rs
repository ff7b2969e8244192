//! Nothing but the decoder of what a host sends: `scripts/proof` looks whether a panic can be reached in it. Whatever bytes
//! arrive, there is then no path from them to one.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};
    // Any byte at all, as far as the compiler knows.
    static BYTE: AtomicU8 = AtomicU8::new(0);
    static HEARD: AtomicUsize = AtomicUsize::new(0);
    let mut inbox = shared::wire::Deframer::new();
    loop {
        let byte = BYTE.load(Ordering::Relaxed);
        if let Some(message) = inbox.push::<shared::wire::ToDevice>(byte) {
            let size = core::mem::size_of_val(core::hint::black_box(&message));
            HEARD.store(size, Ordering::Relaxed);
        }
    }
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

/// There is nothing to run on a PC.
#[cfg(not(target_os = "none"))]
fn main() {}
