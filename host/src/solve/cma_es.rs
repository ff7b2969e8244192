//! Covariance matrix adaptation (Hansen, *The CMA Evolution Strategy: A Tutorial*, 2016) from the
//! crate `cmaes`, restarted with a doubled population while the budget lasts (Auger, Hansen, 2005).

use super::{Evaluator, Solver};
use cmaes::{CMAESOptions, DVector};
use std::cell::RefCell;

/// Settings of CMA-ES.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CmaEs {
    /// First step size, as a part of the cube's edge.
    pub sigma: f64,
    /// Weight of the squared distance outside the cube, relative to the cost at its wall.
    pub wall: f64,
}

impl Default for CmaEs {
    fn default() -> Self {
        CmaEs {
            sigma: 0.25,
            wall: 10.0,
        }
    }
}

impl Solver for CmaEs {
    fn name(&self) -> &'static str {
        "cmaes"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let dim = evaluator.dim();
        let start = evaluator.objective().start();
        let evaluator = RefCell::new(evaluator);
        let left = || evaluator.borrow().left();
        let usual = 4 + (3.0 * (dim as f64).ln()).floor() as usize;
        for restart in 0u32.. {
            if left() == 0 {
                return;
            }
            let cost = |x: &DVector<f64>| {
                let inside: Vec<f64> = x.iter().map(|v| v.clamp(0.0, 1.0)).collect();
                let outside: f64 = x.iter().zip(&inside).map(|(a, b)| (a - b) * (a - b)).sum();
                match evaluator.borrow_mut().evaluate(&inside) {
                    Ok(cost) if cost.is_finite() => cost + self.wall * outside * (1.0 + cost.abs()),
                    // The crate sorts by cost: something huge, and no NaN.
                    _ => f64::MAX * 1e-3,
                }
            };
            let mean = match (&start, restart) {
                (Some(start), 0) => start.clone(),
                _ => vec![0.5; dim],
            };
            let options = CMAESOptions::new(mean, self.sigma)
                .population_size(usual << restart.min(8))
                .max_function_evals(left())
                .seed(seed.wrapping_add(u64::from(restart).wrapping_mul(0x9e37_79b9_7f4a_7c15)));
            let Ok(mut state) = options.build(cost) else {
                return;
            };
            while left() > 0 && state.next().is_none() {}
        }
    }
}
