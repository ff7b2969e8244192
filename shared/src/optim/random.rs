//! Uniform random search: what every other method must beat.

use super::{Candidate, Optimiser, sanitised};
use crate::rng::{self, Generator, Rng};
use crate::scalar::Real;

/// Uniform random search.
#[derive(Clone, Debug)]
pub struct RandomSearch<R, const D: usize, G = Generator> {
    dim: usize,
    rng: G,
    asked: Candidate<R, D>,
    best: Candidate<R, D>,
}

impl<R: Real, const D: usize> RandomSearch<R, D> {
    /// Over `dim` unknowns (at most `D`), with the usual generator.
    pub fn new(dim: usize, seed: u64) -> Self {
        RandomSearch::with(rng::seeded(seed), dim)
    }
}

impl<R: Real, G: Rng, const D: usize> RandomSearch<R, D, G> {
    /// Over `dim` unknowns (at most `D`), with a generator of one's own.
    pub fn with(rng: G, dim: usize) -> Self {
        RandomSearch {
            dim: dim.min(D),
            rng,
            asked: Candidate::unknown(),
            best: Candidate::unknown(),
        }
    }
}

impl<R: Real, G: Rng, const D: usize> Optimiser<R, D> for RandomSearch<R, D, G> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn batch(&self) -> usize {
        1
    }
    fn ask(&mut self) -> [R; D] {
        for x in &mut self.asked.x[..self.dim] {
            *x = rng::uniform(&mut self.rng);
        }
        self.asked.x
    }
    fn tell(&mut self, cost: R) {
        self.asked.cost = sanitised(cost);
        if self.asked.cost < self.best.cost {
            self.best = self.asked;
        }
    }
    fn bound(&self) -> R {
        self.best.cost
    }
    fn best(&self) -> Candidate<R, D> {
        self.best
    }
}
