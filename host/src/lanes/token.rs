//! The proof that the processor at hand has the instructions that lanes are computed with.

use pulp::Simd;
use std::sync::LazyLock;

/// A processor's vector instructions, where it has them.
pub trait Token: Simd {
    /// The proof.
    ///
    /// # Panics
    /// On a processor without them; work in lanes is only begun where they were found.
    fn here() -> Self;
}

impl Token for pulp::Scalar {
    #[inline(always)]
    fn here() -> Self {
        pulp::Scalar::new()
    }
}

#[cfg(target_arch = "x86_64")]
impl Token for pulp::x86::V3 {
    #[inline(always)]
    fn here() -> Self {
        *V3
    }
}

#[cfg(target_arch = "x86_64")]
impl Token for pulp::x86::V4 {
    #[inline(always)]
    fn here() -> Self {
        *V4
    }
}

// Looked up once: this stands in the hot loops, where the processor itself must not be asked.
#[cfg(target_arch = "x86_64")]
static V3: LazyLock<pulp::x86::V3> = LazyLock::new(|| pulp::x86::V3::try_new().expect("AVX2"));
#[cfg(target_arch = "x86_64")]
static V4: LazyLock<pulp::x86::V4> = LazyLock::new(|| pulp::x86::V4::try_new().expect("AVX-512"));
