//! The proof that the processor at hand has the instructions that lanes are computed with.

use super::transpose::Transpose;
use pulp::Simd;
use std::sync::OnceLock;

/// A processor's vector instructions, where it has them.
pub trait Token: Simd + Transpose {
    /// The proof.
    ///
    /// # Panics
    /// On a processor without them; work in lanes is only begun where they were found.
    fn witness() -> Self;
}

#[cfg(target_arch = "x86_64")]
impl Token for pulp::x86::V3 {
    #[inline(always)]
    fn witness() -> Self {
        *V3.get().expect("work in lanes begins with the proof")
    }
}

#[cfg(target_arch = "x86_64")]
impl Token for pulp::x86::V4 {
    #[inline(always)]
    fn witness() -> Self {
        *V4.get().expect("work in lanes begins with the proof")
    }
}

// Looked at wherever a constant is made, in the hot loops too: a look that can lead to no work but a panic leaves
// them straight; one that may have to find out first cost the bristles of LuGre two fifths of their time.
#[cfg(target_arch = "x86_64")]
pub(super) static V3: OnceLock<pulp::x86::V3> = OnceLock::new();
#[cfg(target_arch = "x86_64")]
pub(super) static V4: OnceLock<pulp::x86::V4> = OnceLock::new();
