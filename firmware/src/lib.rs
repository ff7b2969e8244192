//! The application of a servo that identifies its own motor, independent of the board: control logic is here, pin
//! names are not. It runs unchanged on a PC, where the tests put a toy motor in the board's place.
//!
//! - [`board`]: the few things that a board must do, and the boards
//! - [`phase`]: the phases of a self-identification and the rule that leads from one to the next
//! - [`guard`]: limits, stall and runaway: says when a run must end
//! - [`app`]: applies all that to a board, one control period at a time, and talks to the host
//! - [`proof`]: what the PC and a microcontroller must compute alike
//! - [`trials`]: everything that can go wrong, tried out on a bench in memory, on a PC and on a microcontroller
//! - [`count`]: what a microcontroller's arithmetic costs, in instructions
//! - [`log`]: phases, refusals and faults for somebody at a debugger, by defmt
//! - [`bringup`]: another program for the same boards, for their first power-up
#![cfg_attr(target_os = "none", no_std)]
// Unsafe code is only on a microcontroller: what the compiler or the chip finds by its name or section, and the macros that
// bind interrupts.
#![cfg_attr(not(target_os = "none"), forbid(unsafe_code))]

pub mod app;
pub mod board;
pub mod bringup;
pub mod count;
#[cfg(all(target_os = "none", feature = "proof"))]
pub mod emulator;
pub mod encoder;
pub mod guard;
#[cfg(all(target_os = "none", feature = "board"))]
mod halt;
pub mod log;
pub mod phase;
pub mod plant;
pub mod proof;
pub mod trials;
