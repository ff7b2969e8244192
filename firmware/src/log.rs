//! Debug log by defmt: phases, refusals and faults. Over RTT on a board, by semihosting in an emulator,
//! never on the link. Without the feature `defmt` there is nothing of it in an image.

use crate::guard::Tripped;
use crate::phase::Phase;
use shared::wire::{Job, Refusal};

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

// What is logged goes somewhere only if the crate that takes it there is linked.
#[cfg(feature = "defmt-rtt")]
use defmt_rtt as _;
#[cfg(feature = "defmt-semihosting")]
use defmt_semihosting as _;
