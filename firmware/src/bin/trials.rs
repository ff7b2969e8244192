//! Runs the trials of the guards, see `firmware::trials`: on a PC, or on an emulated microcontroller by semihosting, where
//! the application fits in f32 if there is a floating-point unit, in fixed point if there is none. `scripts/proof` runs it.
#![cfg_attr(target_os = "none", no_std, no_main)]

use firmware::app::{Memory, Recording};
use firmware::trials;

#[cfg(target_abi = "eabihf")]
type Format = f32;
#[cfg(not(target_abi = "eabihf"))]
type Format = shared::scalar::Fixed;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    let memory = MEMORY.take();
    // The standard output is the log's, if there is one.
    let out = if cfg!(feature = "defmt-semihosting") {
        cortex_m_semihosting::hio::hstderr()
    } else {
        cortex_m_semihosting::hio::hstdout()
    };
    let ran = out.map(|mut out| trials::run(&mut out, memory, RECORDING.take()));
    firmware::emulator::end(matches!(ran, Ok(Ok(0))))
}

#[cfg(target_os = "none")]
static MEMORY: static_cell::ConstStaticCell<Memory<Format>> =
    static_cell::ConstStaticCell::new(Memory::new());
#[cfg(target_os = "none")]
static RECORDING: static_cell::ConstStaticCell<Recording<{ trials::RECORD }>> =
    static_cell::ConstStaticCell::new(Recording::new());

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    let mut text = String::new();
    let failed = trials::run(
        &mut text,
        &mut Memory::<Format>::new(),
        &mut Recording::new(),
    );
    print!("{text}");
    if failed == Ok(0) {
        std::process::ExitCode::SUCCESS
    } else {
        std::process::ExitCode::FAILURE
    }
}
