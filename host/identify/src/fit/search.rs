//! The search of a problem by one method.

use super::options::Options;
use servoid_engine::block_cost::BlockCost;
use servoid_engine::problem::FitProblem;
use servoid_engine::solve::nelder_mead::NelderMead;
use servoid_engine::solve::{Evaluator, Found, Solver};
use shared::cost::Cost;
use std::sync::atomic::AtomicBool;

/// Part of the budget, at most, for the polish after least squares.
const POLISH: usize = 600;

/// Searches with one method. Least squares minimises squares, whatever the cost is: where the cost
/// is another, a simplex search polishes its result.
pub fn search(
    problem: &FitProblem<'_>,
    solver: &dyn Solver,
    options: &Options,
    stop: &AtomicBool,
    observer: &mut dyn FnMut(usize, f64),
) -> Found {
    let quick = BlockCost::new(problem);
    let mut evaluator = Evaluator::new(&quick, options.budget, stop, observer);
    solver.search(&mut evaluator, options.seed);
    if solver.name() == "lm" && problem.cost != Cost::Squared {
        evaluator.limit(POLISH);
        let polish = NelderMead {
            edge: 1e-3,
            ..NelderMead::default()
        };
        polish.search(&mut evaluator, options.seed);
    }
    evaluator.finish()
}
