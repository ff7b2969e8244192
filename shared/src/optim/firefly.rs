//! Firefly search (Yang, *Nature-Inspired Metaheuristic Algorithms*, 2008): each moves towards those
//! that are brighter, the nearer the more, with a random step that cools.
//!
//! Three things differ from the textbook, and were measured to matter at a population of five: a
//! firefly looks at one brighter one at random (Wang et al., *Int. J. Bio-Inspired Computation* 8(1),
//! 2016), so that an iteration costs one evaluation each; a move is kept only if it makes the firefly
//! brighter; and the brightest one tries a random step too.

use super::{Candidate, Optimiser, sanitised};
use crate::rng::{self, Generator, Rng};
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
pub struct Firefly<R, const P: usize, const D: usize, G = Generator> {
    attraction: R,
    absorption: R,
    narrowest: R,
    dim: usize,
    flies: [Candidate<R, D>; P],
    population: usize,
    /// The firefly whose move is awaiting its cost, and where it would go.
    mover: usize,
    trial: [R; D],
    /// Fireflies whose first cost is known.
    placed: usize,
    step: R,
    cooling: R,
    rng: G,
    best: Candidate<R, D>,
}

impl<R: Real, const P: usize, const D: usize> Firefly<R, P, D> {
    /// `population` (at most `P`) fireflies over `dim` (at most `D`) unknowns, with the usual generator.
    pub fn new(dim: usize, population: usize, settings: FireflySettings, seed: u64) -> Self {
        let mut firefly = Self::idle(rng::seeded(seed));
        firefly.begin(dim, population, settings);
        firefly
    }
}

impl<R: Real, G: Rng, const P: usize, const D: usize> Firefly<R, P, D, G> {
    /// Not begun. A device begins a search where it stays: moved, it would stand on the stack once more.
    #[inline(always)]
    pub fn idle(rng: G) -> Self {
        Firefly {
            attraction: R::ZERO,
            absorption: R::ZERO,
            narrowest: R::ZERO,
            dim: 0,
            flies: [Candidate::EMPTY; P],
            population: 0,
            mover: 0,
            trial: [R::ZERO; D],
            placed: 0,
            step: R::ZERO,
            cooling: R::ZERO,
            rng,
            best: Candidate::EMPTY,
        }
    }

    /// Begins the search: `population` (at most `P`) fireflies over `dim` (at most `D`) unknowns.
    pub fn begin(&mut self, dim: usize, population: usize, settings: FireflySettings) {
        self.dim = dim.min(D);
        for fly in &mut self.flies {
            *fly = Candidate::unknown();
            for x in fly.x.iter_mut().take(self.dim) {
                *x = rng::uniform(&mut self.rng);
            }
        }
        let real = R::from_f64;
        let fall = real(settings.narrowest / settings.widest).ln();
        self.attraction = real(settings.attraction);
        self.absorption = real(settings.absorption);
        self.narrowest = real(settings.narrowest);
        self.population = population.clamp(1, P);
        self.step = real(settings.widest);
        self.cooling = (fall / R::from_whole(settings.evaluations.max(1))).exp();
        self.best = Candidate::unknown();
    }

    /// One of those brighter than the mover, at random.
    fn brighter(&mut self) -> Option<usize> {
        let own = self.flies[self.mover].cost;
        let flies = &self.flies[..self.population];
        let count = flies.iter().filter(|fly| fly.cost < own).count() as u32;
        if count == 0 {
            return None;
        }
        let chosen = rng::below(&mut self.rng, count) as usize;
        let mut brighter = (0..self.population).filter(|&j| self.flies[j].cost < own);
        brighter.nth(chosen)
    }

    /// From the mover's place towards `other` (if any), with the random step.
    fn fly(&mut self, other: Option<usize>) -> [R; D] {
        let half = R::from_f64(0.5);
        let from = self.flies[self.mover].x;
        let (pull, to) = match other {
            None => (R::zero(), from),
            Some(other) => {
                let to = self.flies[other].x;
                let mut distance = R::zero();
                for d in 0..self.dim {
                    distance = distance + (to[d] - from[d]) * (to[d] - from[d]);
                }
                // An attraction that is three thousandths off finds as well.
                let fall = (-(self.absorption * distance)).exp_approx();
                (self.attraction * fall, to)
            }
        };
        let mut x = from;
        for d in 0..self.dim {
            let walk = self.step * (rng::uniform::<R>(&mut self.rng) - half);
            x[d] = reflected(from[d] + pull * (to[d] - from[d]) + walk);
        }
        x
    }
}

/// Back into `[0, 1]` off the walls.
fn reflected<R: Real>(x: R) -> R {
    let (zero, one) = (R::zero(), R::from_f64(1.0));
    let x = if x < zero { -x } else { x };
    let x = if x > one { one + one - x } else { x };
    x.max(zero).min(one)
}

impl<R: Real, G: Rng, const P: usize, const D: usize> Optimiser<R, D> for Firefly<R, P, D, G> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn batch(&self) -> usize {
        1
    }
    fn ask(&mut self) -> [R; D] {
        self.trial = if self.placed < self.population {
            self.flies[self.mover].x
        } else {
            let other = self.brighter();
            self.fly(other)
        };
        self.trial
    }
    fn tell(&mut self, cost: R) {
        let told = Candidate {
            x: self.trial,
            cost: sanitised(cost),
        };
        let first = self.placed < self.population;
        let fly = &mut self.flies[self.mover];
        if first || told.cost < fly.cost {
            told.replace(fly);
        }
        self.placed = (self.placed + 1).min(self.population);
        self.mover = (self.mover + 1) % self.population;
        if told.cost < self.best.cost {
            told.replace(&mut self.best);
        }
        self.step = (self.step * self.cooling).max(self.narrowest);
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
