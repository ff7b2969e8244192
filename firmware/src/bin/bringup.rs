//! First power-up of whatever board the build was told of: see `firmware::bringup`.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cfg_attr(feature = "esp32c6", esp_hal::main)]
#[cfg_attr(not(feature = "esp32c6"), cortex_m_rt::entry)]
fn main() -> ! {
    let mut bringup = firmware::bringup::Bringup::new(firmware::board::Fitted::start());
    loop {
        bringup.period();
    }
}

/// There is nothing to run on a PC: `scripts/boards` builds the image.
#[cfg(not(target_os = "none"))]
fn main() {}
