//! What somebody at a debugger may read: phases and faults, by defmt. On RTT on a board, by semihosting in an emulator, never
//! on the link. Without the feature `defmt` there is nothing of it in an image.

use crate::guard::Tripped;
use crate::phase::Phase;

/// A phase was entered.
#[inline(always)]
pub fn entered(phase: Phase) {
    #[cfg(feature = "defmt")]
    defmt::info!("phase {=str}", name(phase));
    #[cfg(not(feature = "defmt"))]
    let _ = phase;
}

/// A run was given up, in this phase and that many periods after it began.
#[inline(always)]
pub fn tripped(tripped: &Tripped, phase: Phase, at: u32) {
    #[cfg(feature = "defmt")]
    defmt::warn!(
        "fault {=u8} in {=str} after {=u32} periods: {=i32} against {=i32}",
        tripped.fault as u8,
        name(phase),
        at,
        tripped.seen,
        tripped.limit
    );
    #[cfg(not(feature = "defmt"))]
    let _ = (tripped, phase, at);
}

#[cfg(feature = "defmt")]
fn name(phase: Phase) -> &'static str {
    match phase {
        Phase::Idle => "idle",
        Phase::Probe => "probe",
        Phase::Excite => "excite",
        Phase::Record => "record",
        Phase::Fit => "fit",
        Phase::Verify => "verify",
        Phase::Report(_) => "report",
    }
}

// What is logged goes somewhere only if the crate that takes it there is linked.
#[cfg(feature = "defmt-rtt")]
use defmt_rtt as _;
#[cfg(feature = "defmt-semihosting")]
use defmt_semihosting as _;
