//! Seeded chance: the same seed gives the same bits on every machine and in every release.

use std::f64::consts::TAU;

/// SplitMix64 (Steele, Lea, Flood: "Fast splittable pseudorandom number generators", OOPSLA 2014).
/// It is spelt out here, and not taken from a crate, so that a recording made from a printed seed
/// never changes with a dependency.
#[derive(Clone, Debug)]
pub struct Chance {
    state: u64,
}

impl Chance {
    /// The stream that belongs to `purpose` under `seed`. Streams of different purposes are
    /// independent, so that adding one source of noise leaves the others as they were.
    pub fn new(seed: u64, purpose: &str) -> Self {
        // FNV-1a over the purpose, then one round of mixing with the seed.
        let label = purpose
            .bytes()
            .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
                (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
            });
        let mut chance = Chance { state: seed };
        chance.state = chance.next() ^ label;
        chance
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn uniform(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Normal with mean 0 and standard deviation 1 (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_those_of_the_distributions() {
        let mut chance = Chance::new(7, "moments");
        let n = 100_000;
        let uniform: f64 = (0..n).map(|_| chance.uniform()).sum::<f64>() / f64::from(n);
        let square: f64 = (0..n).map(|_| chance.normal().powi(2)).sum::<f64>() / f64::from(n);
        // Five standard errors of either mean.
        assert!(
            (uniform - 0.5).abs() < 5.0 * (1.0 / 12.0 / f64::from(n)).sqrt(),
            "{uniform}"
        );
        assert!(
            (square - 1.0).abs() < 5.0 * (2.0 / f64::from(n)).sqrt(),
            "{square}"
        );
    }

    #[test]
    fn purposes_do_not_share_a_stream() {
        let first = |purpose| Chance::new(1, purpose).uniform();
        assert_ne!(first("jitter"), first("current noise"));
    }
}
