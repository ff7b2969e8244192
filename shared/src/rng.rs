//! Random numbers: a printed seed, and the same bits on the PC and on the microcontroller.

use crate::scalar::Real;

/// A source of random bits.
pub trait Rng {
    /// The next 32.
    fn next_u32(&mut self) -> u32;
    /// The next 64, the lower half first.
    fn next_u64(&mut self) -> u64 {
        let low = self.next_u32();
        (u64::from(self.next_u32()) << 32) | u64::from(low)
    }
}

/// The generator that everything in this crate uses, xoshiro128++ (Blackman and Vigna, 2021): 32-bit arithmetic, 16 bytes of
/// state. Here and not from a crate, because seeding by that takes 400 bytes of a microcontroller's flash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Generator([u32; 4]);

impl Generator {
    /// Not seeded: it would give zeros for ever.
    pub(crate) const EMPTY: Self = Generator([0; 4]);
}

impl Rng for Generator {
    #[cfg_attr(short_multiplier, inline(never))]
    fn next_u32(&mut self) -> u32 {
        let [a, b, c, d] = &mut self.0;
        let random = a.wrapping_add(*d).rotate_left(7).wrapping_add(*a);
        let shifted = *b << 9;
        *c ^= *a;
        *d ^= *b;
        *b ^= *c;
        *a ^= *d;
        *c ^= shifted;
        *d = d.rotate_left(11);
        random
    }
}

/// The generator of this seed, whose state is the first two numbers of SplitMix64 (Steele, Lea and Flood, 2014).
pub fn seeded(seed: u64) -> Generator {
    let mut state = [0; 4];
    let mut x = seed;
    for pair in state.as_chunks_mut::<2>().0 {
        x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = x;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let z = z ^ (z >> 31);
        *pair = [z as u32, (z >> 32) as u32];
    }
    Generator(state)
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
        let mut generator = Generator([1, 2, 3, 4]);
        let first: [u32; 4] = core::array::from_fn(|_| generator.next_u32());
        assert_eq!(first, [641, 1_573_767, 3_222_811_527, 3_517_856_514]);
        // SplitMix64 from 0.
        let [a, b, c, d] = seeded(0).0.map(u64::from);
        assert_eq!((b << 32) | a, 0xe220_a839_7b1d_cdaf);
        assert_eq!((d << 32) | c, 0x6e78_9e6a_a1b9_65f4);
    }
}
