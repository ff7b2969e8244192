//! The chip of a Pico: two Cortex-M0+, of which one is used.

use embassy_rp::pac::VREG_AND_CHIP_RESET;
use shared::wire::Reset;

/// Name of the board.
pub const NAME: &str = "Raspberry Pi Pico";
/// Fixed point: the core has no floating-point unit.
pub type Number = shared::scalar::Fixed;
/// Periods that it can fit.
pub const CAPACITY: usize = 1000;
/// See [`Board::SLICE`](crate::board::Board::SLICE): some 1,500 instructions a sample.
pub const SAMPLES: u32 = 20;
/// Core clock, which `embassy-rp` sets off the board's crystal.
pub const CORE_HZ: u32 = 125_000_000;

/// Why the chip as a whole was reset.
pub fn reset_reason() -> Reset {
    let chip = VREG_AND_CHIP_RESET.chip_reset().read();
    if chip.had_run() {
        Reset::Pin
    } else if chip.had_por() {
        Reset::PowerUp
    } else {
        Reset::Unknown
    }
}
