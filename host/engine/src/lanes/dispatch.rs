//! Work given to the widest vector instructions that the processor at hand has, found out when the program runs.

#[cfg(target_arch = "x86_64")]
use super::token;
use super::token::Token;
use super::transpose::LANES;
use core::marker::PhantomData;

/// A computation in lanes.
pub trait Work {
    /// Its result.
    type Output;
    /// Computes with `M` registers of the processor `T` to a number. Everything hot must be inlined into it, since only
    /// inlined code uses the instructions.
    fn run<T: Token, const M: usize>(self) -> Self::Output;
}

/// Runs `work` with the widest registers that the processor has. Every processor gives the same bits.
pub fn work<W: Work>(work: W) -> W::Output {
    use pulp::{Scalar, Simd};
    #[cfg(target_arch = "x86_64")]
    {
        use pulp::x86::{Arch, V3, V4};
        match Arch::new() {
            Arch::V4(v4) => {
                token::V4.get_or_init(|| v4);
                return Simd::vectorize(v4, On::<W, V4, 1>(work, PhantomData));
            }
            Arch::V3(v3) => {
                token::V3.get_or_init(|| v3);
                return Simd::vectorize(v3, On::<W, V3, 2>(work, PhantomData));
            }
            _ => {}
        }
    }
    Simd::vectorize(Scalar::new(), On::<W, Scalar, LANES>(work, PhantomData))
}

/// Work with the processor fixed by its type.
struct On<W, T, const M: usize>(W, PhantomData<T>);

impl<W: Work, T: Token, const M: usize> pulp::WithSimd for On<W, T, M> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> W::Output {
        self.0.run::<T, M>()
    }
}

/// Runs `body` with the processor's AVX2 instructions where it has them: the same bits, with fewer moves between
/// registers. Everything hot must be inlined into it.
#[cfg(target_arch = "x86_64")]
pub fn with_vectors<A>(body: impl FnOnce() -> A) -> A {
    match pulp::x86::V3::try_new() {
        Some(v3) => pulp::Simd::vectorize(v3, Body(body)),
        None => body(),
    }
}

/// Runs `body`; this processor has no such instructions.
#[cfg(not(target_arch = "x86_64"))]
pub fn with_vectors<A>(body: impl FnOnce() -> A) -> A {
    body()
}

#[cfg(target_arch = "x86_64")]
struct Body<F>(F);

#[cfg(target_arch = "x86_64")]
impl<A, F: FnOnce() -> A> pulp::WithSimd for Body<F> {
    type Output = A;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> A {
        (self.0)()
    }
}
