//! The proof that the processor has the instructions with which lanes are computed.

use super::transpose::Transpose;
use pulp::Simd;
#[cfg(target_arch = "x86_64")]
use std::sync::OnceLock;

/// Instructions with which lanes are computed: vectors of a processor that has them, or those that every processor has.
pub trait Token: Simd + Transpose {
    /// The proof that it has them.
    ///
    /// # Panics
    /// On a processor without them. It cannot happen: only [`work`](super::work) starts work in lanes, once it found them.
    fn witness() -> Self;
}

impl Token for pulp::Scalar {
    #[inline(always)]
    fn witness() -> Self {
        pulp::Scalar::new()
    }
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

// Read wherever a constant is made, in hot loops too. A read that can only succeed or panic costs nothing there;
// detection at the first read took two fifths of LuGre's time.
#[cfg(target_arch = "x86_64")]
pub(super) static V3: OnceLock<pulp::x86::V3> = OnceLock::new();
#[cfg(target_arch = "x86_64")]
pub(super) static V4: OnceLock<pulp::x86::V4> = OnceLock::new();
