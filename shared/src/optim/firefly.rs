//! Firefly search (Yang, 2008): each moves towards all that are brighter, the nearer the more.

use super::{Candidate, Optimiser, sanitised};
use crate::rng::{self, Generator};
use crate::scalar::Real;

/// Settings of [`Firefly`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FireflySettings {
    /// Attraction at no distance.
    pub attraction: f64,
    /// How fast attraction falls with the squared distance, 1/edge².
    pub absorption: f64,
    /// Width of the random step at the start, as a part of the cube's edge.
    pub step: f64,
    /// Factor on the random step from one generation to the next.
    pub cooling: f64,
    /// Narrowest random step.
    pub narrowest: f64,
}

impl Default for FireflySettings {
    fn default() -> Self {
        FireflySettings {
            attraction: 1.0,
            absorption: 1.0,
            step: 0.3,
            cooling: 0.99,
            narrowest: 1e-6,
        }
    }
}

/// Up to `P` fireflies over up to `D` unknowns. One evaluation a firefly and generation.
#[derive(Clone, Debug)]
pub struct Firefly<R, const P: usize, const D: usize> {
    settings: FireflySettings,
    dim: usize,
    flies: [Candidate<R, D>; P],
    population: usize,
    asked: usize,
    told: usize,
    step: R,
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
        Firefly {
            settings,
            dim,
            flies,
            population: population.clamp(1, P),
            asked: 0,
            told: 0,
            step: R::from_f64(settings.step),
            rng,
            best: Candidate::unknown(),
        }
    }

    fn move_all(&mut self) {
        let real = R::from_f64;
        let (zero, one) = (R::zero(), real(1.0));
        let before = self.flies;
        for (i, fly) in self.flies[..self.population].iter_mut().enumerate() {
            for other in &before[..self.population] {
                if other.cost < before[i].cost {
                    let mut distance = zero;
                    for d in 0..self.dim {
                        let gap = other.x[d] - fly.x[d];
                        distance = distance + gap * gap;
                    }
                    let pull = real(self.settings.attraction)
                        * (-(real(self.settings.absorption) * distance)).exp();
                    for d in 0..self.dim {
                        fly.x[d] = fly.x[d] + pull * (other.x[d] - fly.x[d]);
                    }
                }
            }
            for x in &mut fly.x[..self.dim] {
                let walk = self.step * rng::normal::<R>(&mut self.rng);
                *x = (*x + walk).max(zero).min(one);
            }
        }
        self.step = (self.step * real(self.settings.cooling)).max(real(self.settings.narrowest));
    }
}

impl<R: Real, const P: usize, const D: usize> Optimiser<R, D> for Firefly<R, P, D> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn batch(&self) -> usize {
        self.population - self.asked % self.population
    }
    fn ask(&mut self) -> [R; D] {
        if self.asked == self.population {
            self.move_all();
            self.asked = 0;
            self.told = 0;
        }
        let x = self.flies[self.asked].x;
        self.asked += 1;
        x
    }
    fn tell(&mut self, cost: R) {
        let Some(fly) = self.flies[..self.population].get_mut(self.told) else {
            return;
        };
        self.told += 1;
        fly.cost = sanitised(cost);
        if fly.cost < self.best.cost {
            self.best = *fly;
        }
    }
    fn bound(&self) -> R {
        R::from_f64(f64::INFINITY)
    }
    fn best(&self) -> Candidate<R, D> {
        self.best
    }
}
