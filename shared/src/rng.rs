//! Random numbers: a printed seed, and the same bits on the PC and on the microcontroller.

use crate::scalar::Real;
pub use rand_core::{Rng, SeedableRng};
/// The generator that everything in this crate uses (Blackman and Vigna, 2021): 32-bit arithmetic, 16 bytes of state.
pub use rand_xoshiro::Xoshiro128PlusPlus as Generator;

/// The generator of this seed, whose state is the first two numbers of SplitMix64 (Steele, Lea and Flood, 2014).
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

#[cfg(test)]
mod tests {
    use super::*;

    /// From the authors' own C programs, compiled: the first numbers after these states.
    #[test]
    fn it_is_the_published_generator() {
        let mut state = [0; 16];
        for (bytes, word) in state.as_chunks_mut::<4>().0.iter_mut().zip(1u32..) {
            *bytes = word.to_le_bytes();
        }
        let mut generator = Generator::from_seed(state);
        let first: [u32; 4] = core::array::from_fn(|_| generator.next_u32());
        assert_eq!(first, [641, 1_573_767, 3_222_811_527, 3_517_856_514]);
        // The lower half of 64 bits comes first.
        let (mut whole, mut halves) = (seeded(1), seeded(1));
        let low = u64::from(halves.next_u32());
        assert_eq!(whole.next_u64(), u64::from(halves.next_u32()) << 32 | low);
        // SplitMix64 from 0.
        let state = seeded(0).state();
        let words = state
            .as_chunks::<8>()
            .0
            .iter()
            .map(|&b| u64::from_le_bytes(b));
        assert!(words.eq([0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4]));
    }
}
