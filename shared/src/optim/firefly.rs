//! Firefly search (Yang, *Nature-Inspired Metaheuristic Algorithms*, 2008): each moves towards those
//! that are brighter, the nearer the more, with a random step that cools.
//!
//! Two things differ from the textbook, and both were measured to matter at a population of five: a
//! move is kept only if it makes the firefly brighter, and the brightest one tries a random step too.

use super::{Candidate, Optimiser, sanitised};
use crate::rng::{self, Generator};
use crate::scalar::Real;

/// Settings of [`Firefly`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FireflySettings {
    /// Attraction at no distance. Above one a firefly flies past the brighter one, and so looks
    /// beyond it.
    pub attraction: f64,
    /// How fast attraction falls with the squared distance, 1/edge².
    pub absorption: f64,
    /// Width of the random step at the start, as a part of the cube's edge.
    pub widest: f64,
    /// Width of the random step at the end.
    pub narrowest: f64,
    /// Evaluations over which the random step cools from the one to the other.
    pub evaluations: u32,
}

impl Default for FireflySettings {
    fn default() -> Self {
        FireflySettings {
            attraction: 1.5,
            absorption: 1.0,
            widest: 0.1,
            narrowest: 1e-6,
            evaluations: 5000,
        }
    }
}

/// Up to `P` fireflies over up to `D` unknowns; one evaluation a move.
#[derive(Clone, Debug)]
pub struct Firefly<R, const P: usize, const D: usize> {
    settings: FireflySettings,
    dim: usize,
    flies: [Candidate<R, D>; P],
    population: usize,
    /// The firefly that moves, and the one it looks at next.
    mover: usize,
    towards: usize,
    /// Whether the mover has seen a brighter one in this round.
    attracted: bool,
    /// Where it would go; its cost is awaited.
    trial: [R; D],
    /// Fireflies whose first cost is known.
    placed: usize,
    step: R,
    cooling: R,
    rng: Generator,
    best: Candidate<R, D>,
}

impl<R: Real, const P: usize, const D: usize> Firefly<R, P, D> {
    /// `population` (at most `P`) fireflies over `dim` (at most `D`) unknowns.
    pub fn new(dim: usize, population: usize, settings: FireflySettings, seed: u64) -> Self {
        let mut rng = rng::seeded(seed);
        let dim = dim.min(D);
        let flies = core::array::from_fn(|_| {
            let mut fly = Candidate::unknown();
            for x in &mut fly.x[..dim] {
                *x = rng::uniform(&mut rng);
            }
            fly
        });
        let fall = R::from_f64(settings.narrowest / settings.widest).ln();
        Firefly {
            settings,
            dim,
            flies,
            population: population.clamp(1, P),
            mover: 0,
            towards: 0,
            attracted: false,
            trial: [R::zero(); D],
            placed: 0,
            step: R::from_f64(settings.widest),
            cooling: (fall / R::from_f64(settings.evaluations.max(1) as f64)).exp(),
            rng,
            best: Candidate::unknown(),
        }
    }

    /// The mover's next firefly to fly to, if one of the rest is brighter.
    fn next_brighter(&mut self) -> Option<usize> {
        let own = self.flies[self.mover].cost;
        while self.towards < self.population {
            let other = self.towards;
            self.towards += 1;
            if self.flies[other].cost < own {
                return Some(other);
            }
        }
        None
    }

    fn next_mover(&mut self) {
        self.mover = (self.mover + 1) % self.population;
        self.towards = 0;
        self.attracted = false;
    }

    /// Sets the trial: from the mover's place towards `other` (if any), with the random step.
    fn fly(&mut self, other: Option<usize>) {
        let real = R::from_f64;
        let from = self.flies[self.mover].x;
        let (pull, to) = match other {
            None => (R::zero(), from),
            Some(other) => {
                let to = self.flies[other].x;
                let mut distance = R::zero();
                for d in 0..self.dim {
                    distance = distance + (to[d] - from[d]) * (to[d] - from[d]);
                }
                let fall = (-(real(self.settings.absorption) * distance)).exp();
                (real(self.settings.attraction) * fall, to)
            }
        };
        for d in 0..self.dim {
            let walk = self.step * (rng::uniform::<R>(&mut self.rng) - real(0.5));
            self.trial[d] = reflected(from[d] + pull * (to[d] - from[d]) + walk);
        }
    }
}

/// Back into `[0, 1]` off the walls.
fn reflected<R: Real>(x: R) -> R {
    let (zero, one) = (R::zero(), R::from_f64(1.0));
    let x = if x < zero { -x } else { x };
    let x = if x > one { one + one - x } else { x };
    x.max(zero).min(one)
}

impl<R: Real, const P: usize, const D: usize> Optimiser<R, D> for Firefly<R, P, D> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn batch(&self) -> usize {
        1
    }
    fn ask(&mut self) -> [R; D] {
        if self.placed < self.population {
            self.trial = self.flies[self.placed].x;
            return self.trial;
        }
        loop {
            if let Some(other) = self.next_brighter() {
                self.attracted = true;
                self.fly(Some(other));
                return self.trial;
            }
            if !self.attracted {
                self.attracted = true;
                self.fly(None);
                return self.trial;
            }
            self.next_mover();
        }
    }
    fn tell(&mut self, cost: R) {
        let cost = sanitised(cost);
        let first = self.placed < self.population;
        let mover = if first { self.placed } else { self.mover };
        if first {
            self.placed += 1;
        }
        if first || cost < self.flies[mover].cost {
            self.flies[mover] = Candidate { x: self.trial, cost };
        }
        if cost < self.best.cost {
            self.best = Candidate { x: self.trial, cost };
        }
        self.step = (self.step * self.cooling).max(R::from_f64(self.settings.narrowest));
    }
    fn bound(&self) -> R {
        if self.placed < self.population {
            R::from_f64(f64::INFINITY)
        } else {
            self.flies[self.mover].cost
        }
    }
    fn best(&self) -> Candidate<R, D> {
        self.best
    }
}
