//! Random numbers: a printed seed, and the same bits on the PC and on the microcontroller.

use crate::scalar::Real;
pub use rand_core::{Rng, SeedableRng};
pub use rand_xoshiro::Xoshiro128PlusPlus as Generator;

/// The generator that everything in this crate uses: 32-bit arithmetic, 16 bytes of state.
pub fn seeded(seed: u64) -> Generator {
    Generator::seed_from_u64(seed)
}

/// Uniform in `[0, 1)`.
pub fn uniform<R: Real>(rng: &mut impl Rng) -> R {
    R::from_bits_uniform(rng.next_u64())
}

/// Uniform whole number below `bound` (which must be at least 1).
pub fn below(rng: &mut impl Rng, bound: u32) -> u32 {
    ((rng.next_u32() as u64 * bound as u64) >> 32) as u32
}

/// Standard normal (Box and Muller, 1958).
pub fn normal<R: Real>(rng: &mut impl Rng) -> R {
    let one = R::from_f64(1.0);
    let radius = (R::from_f64(-2.0) * (one - uniform::<R>(rng)).ln()).sqrt();
    radius * uniform::<R>(rng).sin_cos_turns().1
}
