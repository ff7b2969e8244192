//! Debug log by defmt: starts, phases, refusals, faults and crashes. Over RTT on a board, by semihosting in an emulator,
//! never on the link. Without the feature `defmt` there is nothing of it in an image.

use core::panic::PanicInfo;

use crate::guard::Tripped;
use crate::phase::Phase;
use shared::wire::{Job, Refusal, Reset};

/// The program has started, for this reason.
#[inline(always)]
pub fn woke(reset: Reset) {
    #[cfg(feature = "defmt")]
    defmt::info!("started by {}", reset);
    #[cfg(not(feature = "defmt"))]
    let _ = reset;
}

/// A phase was entered.
#[inline(always)]
pub fn entered(phase: Phase) {
    #[cfg(feature = "defmt")]
    defmt::info!("phase {}", phase);
    #[cfg(not(feature = "defmt"))]
    let _ = phase;
}

/// A run was begun.
#[inline(always)]
pub fn started(job: &Job) {
    #[cfg(feature = "defmt")]
    defmt::info!("start {}", job);
    #[cfg(not(feature = "defmt"))]
    let _ = job;
}

/// A command was refused.
#[inline(always)]
pub fn refused(refusal: Refusal) {
    #[cfg(feature = "defmt")]
    defmt::warn!("refused: {}", refusal);
    #[cfg(not(feature = "defmt"))]
    let _ = refusal;
}

/// A run was given up, in this phase and that many periods after it began.
#[inline(always)]
pub fn tripped(tripped: &Tripped, phase: Phase, at: u32) {
    #[cfg(feature = "defmt")]
    defmt::warn!("{} in {} after {=u32} periods", tripped, phase, at);
    #[cfg(not(feature = "defmt"))]
    let _ = (tripped, phase, at);
}

/// The program panicked: where and why. Waits until the log has been read, if somebody reads it; the bridge must be open.
#[inline(always)]
pub fn panicked(info: &PanicInfo) {
    #[cfg(feature = "defmt")]
    {
        defmt::error!("{}", defmt::Display2Format(info));
        defmt::flush();
    }
    #[cfg(not(feature = "defmt"))]
    let _ = info;
}

/// The processor faulted at the instruction `pc`, in a function that returns to `lr`. Waits like [`panicked`].
#[inline(always)]
pub fn crashed(pc: u32, lr: u32) {
    #[cfg(feature = "defmt")]
    {
        defmt::error!(
            "hard fault at {=u32:#010x}, called from {=u32:#010x}",
            pc,
            lr
        );
        defmt::flush();
    }
    #[cfg(not(feature = "defmt"))]
    let _ = (pc, lr);
}

// What is logged goes somewhere only if the crate that takes it there is linked.
#[cfg(feature = "defmt-rtt")]
use defmt_rtt as _;
#[cfg(feature = "defmt-semihosting")]
use defmt_semihosting as _;
