//! Prints what must be the same everywhere, see `firmware::proof`: on a PC, or on an emulated microcontroller by
//! semihosting. `scripts/proof` compares.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};
    let proved =
        cortex_m_semihosting::hio::hstdout().map(|mut out| firmware::proof::prove(&mut out));
    exit(if matches!(proved, Ok(Ok(()))) {
        EXIT_SUCCESS
    } else {
        EXIT_FAILURE
    });
    loop {}
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    cortex_m_semihosting::debug::exit(cortex_m_semihosting::debug::EXIT_FAILURE);
    loop {}
}

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), std::fmt::Error> {
    let mut text = String::new();
    firmware::proof::prove(&mut text)?;
    print!("{text}");
    Ok(())
}
