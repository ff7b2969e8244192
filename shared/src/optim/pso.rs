//! Particle swarm (Kennedy, Eberhart, 1995) with inertia weight (Shi, Eberhart, 1998).

use super::{Candidate, Optimiser, sanitised};
use crate::rng::{self, Generator, Rng};
use crate::scalar::Real;

/// Settings of [`Pso`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PsoSettings {
    /// Part of the velocity that is kept.
    pub inertia: f64,
    /// Pull towards a particle's own best point.
    pub cognitive: f64,
    /// Pull towards the swarm's best point.
    pub social: f64,
    /// Largest velocity, as a part of the cube's edge.
    pub fastest: f64,
}

impl Default for PsoSettings {
    /// Near the constriction coefficients of Clerc and Kennedy (2002), with more weight on the
    /// swarm: of the settings tried at a population of five on a motor's step response, those with
    /// the largest share of successful seeds (85 % against 74 %).
    fn default() -> Self {
        PsoSettings {
            inertia: 0.7,
            cognitive: 1.2,
            social: 1.8,
            fastest: 1.0,
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Particle<R, const D: usize> {
    x: [R; D],
    velocity: [R; D],
    best: Candidate<R, D>,
}

/// Particle swarm of up to `P` particles over up to `D` unknowns.
///
/// ```
/// use shared::optim::{Optimiser, Pso, PsoSettings};
///
/// // Ten particles over two unknowns, seed 1; the minimum is at (0.2, 0.7).
/// let mut swarm = Pso::<f64, 10, 2>::new(2, 10, PsoSettings::default(), 1);
/// for _ in 0..1000 {
///     let [a, b] = swarm.ask();
///     swarm.tell((a - 0.2).powi(2) + (b - 0.7).powi(2));
/// }
/// let [a, b] = swarm.best().x;
/// assert!((a - 0.2).abs() < 1e-3 && (b - 0.7).abs() < 1e-3);
/// ```
#[derive(Clone, Debug)]
pub struct Pso<R, const P: usize, const D: usize, G = Generator> {
    inertia: R,
    cognitive: R,
    social: R,
    fastest: R,
    dim: usize,
    particles: [Particle<R, D>; P],
    population: usize,
    asked: usize,
    told: usize,
    /// False while the first positions are visited.
    flying: bool,
    rng: G,
    best: Candidate<R, D>,
}

impl<R: Real, const P: usize, const D: usize> Pso<R, P, D> {
    /// `population` (at most `P`) particles over `dim` (at most `D`) unknowns, with the usual generator.
    pub fn new(dim: usize, population: usize, settings: PsoSettings, seed: u64) -> Self {
        let mut pso = Self::idle(rng::seeded(seed));
        pso.begin(dim, population, settings);
        pso
    }
}

impl<R: Real, G: Rng, const P: usize, const D: usize> Pso<R, P, D, G> {
    /// Not begun. A device begins a search where it stays: moved, it would stand on the stack once more.
    #[inline(always)]
    pub fn idle(rng: G) -> Self {
        Pso {
            inertia: R::ZERO,
            cognitive: R::ZERO,
            social: R::ZERO,
            fastest: R::ZERO,
            dim: 0,
            particles: [Particle {
                x: [R::ZERO; D],
                velocity: [R::ZERO; D],
                best: Candidate::EMPTY,
            }; P],
            population: 0,
            asked: 0,
            told: 0,
            flying: false,
            rng,
            best: Candidate::EMPTY,
        }
    }

    /// Begins the search: `population` (at most `P`) particles over `dim` (at most `D`) unknowns.
    pub fn begin(&mut self, dim: usize, population: usize, settings: PsoSettings) {
        self.dim = dim.min(D);
        for particle in &mut self.particles {
            let places = particle.x.iter_mut().zip(&mut particle.velocity);
            for (x, velocity) in places.take(self.dim) {
                *x = rng::uniform(&mut self.rng);
                *velocity = (rng::uniform::<R>(&mut self.rng) - *x) * R::from_f64(0.5);
            }
            particle.best = Candidate::unknown();
        }
        let real = R::from_f64;
        self.inertia = real(settings.inertia);
        self.cognitive = real(settings.cognitive);
        self.social = real(settings.social);
        self.fastest = real(settings.fastest);
        self.population = population.clamp(1, P);
        self.best = Candidate::unknown();
    }

    /// Moves particle `i`. One that would leave the cube stops at random between where it was and
    /// the wall, so that a corner can be neared but does not catch it.
    fn fly(&mut self, i: usize) {
        let (zero, one, fastest) = (R::zero(), R::from_f64(1.0), self.fastest);
        let particle = &mut self.particles[i];
        for d in 0..self.dim {
            let x = particle.x[d];
            let own = self.cognitive * rng::uniform::<R>(&mut self.rng);
            let swarm = self.social * rng::uniform::<R>(&mut self.rng);
            let velocity = self.inertia * particle.velocity[d]
                + own * (particle.best.x[d] - x)
                + swarm * (self.best.x[d] - x);
            let velocity = velocity.min(fastest).max(-fastest);
            let mut next = x + velocity;
            if next < zero || next > one {
                let wall = if next < zero { zero } else { one };
                next = x + (wall - x) * rng::uniform::<R>(&mut self.rng);
            }
            particle.velocity[d] = next - x;
            particle.x[d] = next;
        }
    }
}

impl<R: Real, G: Rng, const P: usize, const D: usize> Optimiser<R, D> for Pso<R, P, D, G> {
    fn dim(&self) -> usize {
        self.dim
    }
    fn batch(&self) -> usize {
        self.population - self.asked % self.population
    }
    fn ask(&mut self) -> [R; D] {
        if self.asked == self.population {
            self.asked = 0;
            self.told = 0;
            self.flying = true;
        }
        if self.flying {
            // One by one, so that each knows what those before it have found.
            self.fly(self.asked);
        }
        let x = self.particles[self.asked].x;
        self.asked += 1;
        x
    }
    fn tell(&mut self, cost: R) {
        let Some(particle) = self.particles[..self.population].get_mut(self.told) else {
            return;
        };
        self.told += 1;
        let cost = sanitised(cost);
        // The first visit counts even if it is impossible: a particle needs a best point.
        if cost < particle.best.cost || !particle.best.cost.is_finite() {
            particle.best = Candidate {
                x: particle.x,
                cost,
            };
            if cost < self.best.cost || !self.best.cost.is_finite() {
                self.best = particle.best;
            }
        }
    }
    fn bound(&self) -> R {
        let oldest = self.told.min(self.population - 1);
        self.particles[oldest].best.cost
    }
    fn best(&self) -> Candidate<R, D> {
        self.best
    }
}
