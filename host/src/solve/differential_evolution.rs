//! Differential evolution (Storn, Price, *Journal of Global Optimization* 11, 1997) from the crate
//! `metaheuristics-nature`: DE/best/1 with independent crossover of the coordinates.

use super::{Evaluator, Solver};
use metaheuristics_nature::{Bounded, De, ObjFunc, Solver as Engine, Strategy};
use std::sync::Mutex;

/// Settings of differential evolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DifferentialEvolution {
    /// Individuals; 0 for five to an unknown, at least twenty.
    pub population: usize,
    /// Weight of a difference vector.
    pub weight: f64,
    /// Chance that a coordinate comes from the mutant.
    pub crossover: f64,
}

impl Default for DifferentialEvolution {
    fn default() -> Self {
        DifferentialEvolution {
            population: 0,
            weight: 0.6,
            crossover: 0.9,
        }
    }
}

/// The evaluator as the crate wants it: shared, and without a way to say stop; points after the
/// budget's end cost infinity and are not evaluated.
struct Counted<'a, 'b> {
    bounds: Vec<[f64; 2]>,
    evaluator: Mutex<&'a mut Evaluator<'b>>,
}

impl Bounded for Counted<'_, '_> {
    fn bound(&self) -> &[[f64; 2]] {
        &self.bounds
    }
}

impl ObjFunc for Counted<'_, '_> {
    type Ys = f64;

    fn fitness(&self, x: &[f64]) -> f64 {
        match self.evaluator.lock() {
            Ok(mut evaluator) => evaluator.evaluate(x).unwrap_or(f64::INFINITY),
            Err(_) => f64::INFINITY,
        }
    }
}

impl Counted<'_, '_> {
    fn finished(&self) -> bool {
        self.evaluator
            .lock()
            .map_or(true, |evaluator| evaluator.left() == 0)
    }
}

impl Solver for DifferentialEvolution {
    fn name(&self) -> &'static str {
        "de"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let dim = evaluator.dim();
        let population = if self.population > 0 {
            self.population
        } else {
            (5 * dim).max(20)
        };
        let settings = De::new()
            .strategy(Strategy::C2F1)
            .f(self.weight)
            .cross(self.crossover);
        let counted = Counted {
            bounds: vec![[0.0, 1.0]; dim],
            evaluator: Mutex::new(evaluator),
        };
        // What it found is in the evaluator.
        let _ = Engine::build(settings, counted)
            .seed(seed)
            .pop_num(population.max(6))
            .task(|context| context.func.finished())
            .solve();
    }
}
