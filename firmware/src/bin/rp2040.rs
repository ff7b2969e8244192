//! The application on a Raspberry Pi Pico; see `firmware::board::rp2040` for what is connected where.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let mut app = firmware::app::App::new(firmware::board::rp2040::Rp2040::start());
    loop {
        app.period(0);
    }
}

/// There is nothing to run on a PC: `scripts/boards` builds the image.
#[cfg(not(target_os = "none"))]
fn main() {}
