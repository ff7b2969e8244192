//! The application of a servo that identifies its own motor, without a board: what to do next is here, what a pin is
//! called is not. It runs unchanged on a PC, where the tests put a toy motor in the board's place.
//!
//! - [`board`]: the few things that a board must do, and nothing that is common to all
//! - [`phase`]: the phases of a self-identification and the rule that leads from one to the next
//! - [`app`]: applies that rule to a board, one control period at a time
//! - [`bringup`]: another program for the same boards, for their first power-up
//!
//! Not here yet: boards, the link to the host, the guard that recognises a stall or an overtravel, and the work that is
//! done inside the phases (excitation, the log, fitting on the device). Until then whoever drives [`app::App`] supplies
//! the duty and says when a phase is done.
#![cfg_attr(target_os = "none", no_std)]
// The macros that bind an interrupt to its handler contain the only unsafe code there is, and only on a microcontroller.
#![cfg_attr(not(target_os = "none"), forbid(unsafe_code))]

pub mod app;
pub mod board;
pub mod bringup;
#[cfg(all(target_os = "none", any(feature = "rp2040", feature = "stm32")))]
mod halt;
pub mod phase;
