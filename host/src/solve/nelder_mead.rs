//! The simplex of Nelder and Mead (1965) from the crate `argmin`, restarted around the best point
//! (and then at random) while the budget lasts.

use super::{Evaluator, Solver};
use argmin::core::{CostFunction, Executor};
use argmin::solver::neldermead::NelderMead as Simplex;
use shared::rng;
use std::cell::RefCell;

/// Settings of the simplex search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NelderMead {
    /// Edge of the first simplex, as a part of the cube's edge.
    pub edge: f64,
    /// Spread of the simplex's costs, relative to the least, at which it has converged.
    pub tolerance: f64,
}

impl Default for NelderMead {
    fn default() -> Self {
        NelderMead {
            edge: 0.1,
            tolerance: 1e-9,
        }
    }
}

/// The evaluator as `argmin` wants it.
struct Counted<'a, 'b>(&'a RefCell<&'a mut Evaluator<'b>>);

impl CostFunction for Counted<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, argmin::core::Error> {
        // `argmin` panics if an error meets its first simplex: once the budget is spent every point
        // costs infinity instead, until the iterations, never more than evaluations, run out too.
        Ok(self.0.borrow_mut().evaluate(x).unwrap_or(f64::INFINITY))
    }
}

impl Solver for NelderMead {
    fn name(&self) -> &'static str {
        "nelder_mead"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let mut rng = rng::seeded(seed);
        let dim = evaluator.dim();
        let mut centre = evaluator.best_or_start();
        let cell = RefCell::new(evaluator);
        let (mut edge, mut reached) = (self.edge, f64::INFINITY);
        let mut left = usize::MAX;
        // A simplex of no extent would converge without an evaluation, for ever.
        while (1..left).contains(&cell.borrow().left()) {
            left = cell.borrow().left();
            let mut corners = vec![centre.clone()];
            for k in 0..dim {
                let mut corner = centre.clone();
                // Inwards, so that no corner is clamped onto another.
                corner[k] += if corner[k] < 0.5 { edge } else { -edge };
                corners.push(corner);
            }
            let tolerance = self.tolerance * reached.clamp(f64::MIN_POSITIVE, 1.0);
            let Ok(simplex) = Simplex::new(corners).with_sd_tolerance(tolerance) else {
                return;
            };
            let iterations = left as u64;
            let run = Executor::new(Counted(&cell), simplex)
                .configure(|state| state.max_iters(iterations))
                .run();
            if run.is_err() {
                return;
            }
            let best = cell.borrow().best_cost();
            let improved = best < reached * (1.0 - 1e-6);
            reached = best;
            (centre, edge) = if improved {
                (cell.borrow().best_or_start(), edge * 0.5)
            } else {
                (
                    (0..dim).map(|_| rng::uniform(&mut rng)).collect(),
                    self.edge,
                )
            };
        }
    }
}
