//! Levenberg and Marquardt's method over the residuals, by the crate `levenberg-marquardt` (a
//! translation of MINPACK), with the Jacobian by finite differences.
//!
//! The crate knows no bounds. Steps that leave the cube are projected onto it, a coordinate that
//! stands at a wall with a cost that does not fall inwards is held there (its column of the Jacobian is
//! zero), and a run that met a wall is repeated from a little inside of where it ended as long as that helps: a
//! coordinate once held must be able to come back, and where the cost is flat at the wall no slope leads it back.
//!
//! Sources: D. W. Marquardt, *J. SIAM* 11, 431, 1963, doi:10.1137/0111030; J. J. Moré, *Numerical
//! Analysis*, Lecture Notes in Mathematics 630, 105, 1978, doi:10.1007/BFb0067700.

mod compact;
mod residuals;

use super::{Evaluator, Solver};
use compact::Compact;
use levenberg_marquardt::LevenbergMarquardt as Minpack;
use nalgebra::DVector;
use residuals::{Descended, Residuals};
use shared::rng;

/// Levenberg–Marquardt from the objective's start, else from the cube's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevenbergMarquardt {
    /// Relative change of the sum of squares, and of the point, at which it has converged.
    pub tolerance: f64,
}

impl Default for LevenbergMarquardt {
    fn default() -> Self {
        LevenbergMarquardt { tolerance: 1e-9 }
    }
}

/// Step of the differences, as a share of the cube's side; inwards at a wall.
const STEP: f64 = 1e-6;
/// Starts where the model is impossible that are replaced by random ones.
const IMPOSSIBLE_STARTS: usize = 100;
/// A run from the wall is repeated if it lowered the sum of squares by more than this part.
const WORTHWHILE: f64 = 1e-6;
/// Distance from a wall at which it is repeated, as a share of the cube's side.
const INSIDE: f64 = 1e-3;
/// Evaluations allowed to one run, per coordinate; the budget ends it long before.
const PATIENCE: usize = 1_000_000;

impl Solver for LevenbergMarquardt {
    fn name(&self) -> &'static str {
        "lm"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64) {
        let dim = evaluator.dim();
        let mut rng = rng::seeded(seed);
        let mut start = evaluator.best_or_start();
        for _ in 0..=IMPOSSIBLE_STARTS {
            if self.descend(evaluator, start) {
                return;
            }
            start = (0..dim).map(|_| rng::uniform(&mut rng)).collect();
        }
        // Nothing to report otherwise; where there are no residuals there may yet be a cost.
        let _ = evaluator.evaluate(&evaluator.best_or_start());
    }
}

impl LevenbergMarquardt {
    /// Whether there was anything to descend from.
    fn descend(&self, evaluator: &mut Evaluator<'_>, start: Vec<f64>) -> bool {
        let minpack = Minpack::new()
            .with_tol(self.tolerance)
            .with_patience(PATIENCE);
        let mut x = DVector::from_vec(start);
        let mut last = f64::INFINITY;
        while evaluator.left() > 0 {
            let (end, squares): (Box<dyn Descended + '_>, f64) =
                match evaluator.objective().compressed() {
                    Some(compressed) => {
                        let problem = Compact::new(compressed, evaluator, x);
                        let (end, report) = minpack.minimize(problem);
                        (Box::new(end), report.objective_function)
                    }
                    None => {
                        let (end, report) = minpack.minimize(Residuals::new(evaluator, x));
                        (Box::new(end), report.objective_function)
                    }
                };
            let again = end.met_wall() && squares < last * (1.0 - WORTHWHILE);
            let begun = end.evaluated();
            x = end.inside().map(|x| x.clamp(INSIDE, 1.0 - INSIDE));
            if !again {
                return begun;
            }
            last = squares;
        }
        true
    }
}
