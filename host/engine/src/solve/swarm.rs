//! The lean optimisers of `shared`, the same code that runs on the microcontroller, behind the
//! host's door.

use super::{Evaluator, Solver};
use shared::optim::{Firefly, FireflySettings, Optimiser, Pso, PsoSettings, RandomSearch};

/// Largest population.
pub const MAX_POPULATION: usize = 64;
/// Most unknowns.
pub const MAX_UNKNOWNS: usize = 40;
/// Usual population.
const POPULATION: usize = 20;

/// Asks and tells until the evaluator says stop.
fn drive(mut optimiser: impl Optimiser<f64, MAX_UNKNOWNS>, evaluator: &mut Evaluator<'_>) {
    let dim = evaluator.dim();
    loop {
        let x = optimiser.ask();
        // All of them only compare costs.
        match evaluator.evaluate_within(&x[..dim], optimiser.bound()) {
            Ok(cost) => optimiser.tell(cost),
            Err(_) => return,
        }
    }
}

/// Particle swarm, see [`shared::optim::Pso`].
#[derive(Clone, Copy, Debug)]
pub struct ParticleSwarm {
    /// Particles.
    pub population: usize,
    /// Settings.
    pub settings: PsoSettings,
}

impl Default for ParticleSwarm {
    fn default() -> Self {
        ParticleSwarm {
            population: POPULATION,
            settings: PsoSettings::default(),
        }
    }
}

impl Solver for ParticleSwarm {
    fn name(&self) -> &'static str {
        "pso"
    }
    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let dim = evaluator.dim();
        let swarm = Pso::<f64, MAX_POPULATION, MAX_UNKNOWNS>::new(
            dim,
            self.population,
            self.settings,
            seed,
        );
        drive(swarm, evaluator);
    }
}

/// Fireflies, see [`shared::optim::Firefly`].
#[derive(Clone, Copy, Debug)]
pub struct Fireflies {
    /// Fireflies.
    pub population: usize,
    /// Settings.
    pub settings: FireflySettings,
}

impl Default for Fireflies {
    fn default() -> Self {
        Fireflies {
            population: POPULATION,
            settings: FireflySettings::default(),
        }
    }
}

impl Solver for Fireflies {
    fn name(&self) -> &'static str {
        "firefly"
    }
    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let dim = evaluator.dim();
        // The random step cools over the whole of the budget.
        let evaluations = u32::try_from(evaluator.left()).unwrap_or(u32::MAX);
        let settings = FireflySettings {
            evaluations,
            ..self.settings
        };
        let flies =
            Firefly::<f64, MAX_POPULATION, MAX_UNKNOWNS>::new(dim, self.population, settings, seed);
        drive(flies, evaluator);
    }
}

/// Uniform random search, see [`shared::optim::RandomSearch`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Random;

impl Solver for Random {
    fn name(&self) -> &'static str {
        "random"
    }
    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        drive(
            RandomSearch::<f64, MAX_UNKNOWNS>::new(evaluator.dim(), seed),
            evaluator,
        );
    }
}
