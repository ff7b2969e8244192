//! Prints what must be the same everywhere, see `firmware::proof`: on a PC, or on an emulated microcontroller by
//! semihosting. `scripts/proof` compares.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let proved =
        cortex_m_semihosting::hio::hstdout().map(|mut out| firmware::proof::prove(&mut out));
    firmware::emulator::end(matches!(proved, Ok(Ok(()))))
}

#[cfg(not(target_os = "none"))]
fn main() -> Result<(), std::fmt::Error> {
    let mut text = String::new();
    firmware::proof::prove(&mut text)?;
    print!("{text}");
    Ok(())
}
