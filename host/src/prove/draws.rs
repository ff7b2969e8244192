//! Random draws of a case, from a stream that belongs to its seed, its number and a purpose.

use servoid_plant::effects::Random;
use shared::rng::{self, Generator, Rng};

/// A stream of draws.
pub struct Draws(Generator);

impl Draws {
    /// The stream of these keys, taken in order: independent of the streams of all other keys.
    pub fn of(keys: &[u64]) -> Self {
        let mixed = keys
            .iter()
            .fold(0, |state, key| rng::seeded(state ^ key).next_u64());
        Draws(rng::seeded(mixed))
    }

    /// A seed for something else that is random; of 32 bits, so that every reader of JSON keeps it.
    pub fn seed(&mut self) -> u64 {
        u64::from(self.0.next_u32())
    }

    /// Uniform from `low` to `high`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        rounded(low + (high - low) * rng::uniform::<f64>(&mut self.0))
    }

    /// Uniform in the logarithm, from `low` to `high`, both above zero.
    pub fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        rounded(self.uniform(low.ln(), high.ln()).exp())
    }

    /// True with the chance `part`.
    pub fn chance(&mut self, part: f64) -> bool {
        rng::uniform::<f64>(&mut self.0) < part
    }

    /// An index below `bound`, or 0 where `bound` is 0.
    pub fn below(&mut self, bound: usize) -> usize {
        rng::below(&mut self.0, bound as u32) as usize
    }

    /// One of `items`; `None` of none.
    pub fn pick<T: Copy>(&mut self, items: &[T]) -> Option<T> {
        let index = self.below(items.len());
        items.get(index).copied()
    }

    /// The whole numbers below `bound` in random order (Fisher and Yates).
    pub fn permutation(&mut self, bound: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..bound).collect();
        for last in (1..bound).rev() {
            order.swap(last, self.below(last + 1));
        }
        order
    }
}

impl Random for Draws {
    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        Draws::uniform(self, low, high)
    }

    fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        Draws::log_uniform(self, low, high)
    }

    fn chance(&mut self, part: f64) -> bool {
        Draws::chance(self, part)
    }
}

/// To six digits, so that what is printed is what was used.
pub fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
