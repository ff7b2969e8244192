//! Uniform random search: what every other method must beat.

use super::{Candidate, Optimiser, sanitised};
use crate::rng::{self, Generator};
use crate::scalar::Real;

/// Uniform random search.
#[derive(Clone, Debug)]
pub struct RandomSearch<R, const D: usize> {
    dim: usize,
    rng: Generator,
    asked: Candidate<R, D>,
    best: Candidate<R, D>,
}

impl<R: Real, const D: usize> RandomSearch<R, D> {
    /// Over `dim` unknowns (at most `D`).
    pub fn new(dim: usize, seed: u64) -> Self {
        RandomSearch {
            dim: dim.min(D),
            rng: rng::seeded(seed),
            asked: Candidate::unknown(),
            best: Candidate::unknown(),
        }
    }
}

impl<R: Real, const D: usize> Optimiser<R, D> for RandomSearch<R, D> {
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
