//! The chip of a Pico 2: two Cortex-M33 with floating-point units, of which one is used.

use embassy_rp::pac::POWMAN;
use shared::wire::Reset;

/// Name of the board.
pub const NAME: &str = "Raspberry Pi Pico 2";
/// The core has a floating-point unit.
pub type Number = f32;
/// Periods that it can fit.
pub const CAPACITY: usize = 2000;
/// See [`Board::SLICE`](crate::board::Board::SLICE): as an STM32F4, with something off for the flash behind a cache.
pub const SAMPLES: u32 = 600;
/// Core clock, which `embassy-rp` sets off the board's crystal.
pub const CORE_HZ: u32 = 150_000_000;

/// Why the chip as a whole was reset.
pub fn reset_reason() -> Reset {
    let chip = POWMAN.chip_reset().read();
    if chip.had_run_low() {
        Reset::Pin
    } else if chip.had_por() {
        Reset::PowerUp
    } else if chip.had_bor() {
        Reset::BrownOut
    } else {
        Reset::Unknown
    }
}
