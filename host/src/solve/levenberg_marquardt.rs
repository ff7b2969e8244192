//! Levenberg and Marquardt's least squares (Moré, 1978) from the crate `levenberg-marquardt`, with
//! difference quotients for the Jacobian. Every simulated residual vector is one evaluation.
//!
//! The crate knows no bounds. A point outside the cube is moved to its wall; a coordinate that lies
//! on a wall and would go further out is frozen (its column of the Jacobian is zero); and the search
//! starts again from where it ended until that helps no more, since a wall may have bent its path.

use super::{Evaluator, Solver};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt as Engine};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use std::cell::RefCell;

/// Settings of Levenberg–Marquardt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevenbergMarquardt {
    /// Step of a difference quotient, as a part of the cube's edge.
    pub step: f64,
    /// Relative change of the sum of squares, or of the point, at which it has converged.
    pub tolerance: f64,
    /// Relative fall of the sum of squares that a restart must bring to be worth another.
    pub worthwhile: f64,
}

impl Default for LevenbergMarquardt {
    fn default() -> Self {
        LevenbergMarquardt {
            step: 1e-6,
            tolerance: 1e-9,
            worthwhile: 1e-3,
        }
    }
}

struct Problem<'a, 'b> {
    /// In a cell, since the crate asks for the Jacobian of something it may not change.
    evaluator: RefCell<&'a mut Evaluator<'b>>,
    at: DVector<f64>,
    residuals: Option<DVector<f64>>,
    step: f64,
}

impl Problem<'_, '_> {
    /// Residuals at `x`, booked as one evaluation; `None` once the budget is spent or where the
    /// model cannot run.
    fn run(&self, x: &DVector<f64>) -> Option<DVector<f64>> {
        let mut evaluator = self.evaluator.borrow_mut();
        if evaluator.left() == 0 {
            return None;
        }
        let (residuals, cost) = evaluator.objective().residuals_and_cost(x.as_slice())?;
        evaluator.record(x.as_slice(), cost);
        Some(DVector::from_vec(residuals))
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_, '_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        let inside = x.map(|v| v.clamp(0.0, 1.0));
        if self.residuals.is_none() || inside != self.at {
            self.residuals = self.run(&inside);
            self.at = inside;
        }
    }

    fn params(&self) -> DVector<f64> {
        self.at.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        self.residuals.clone()
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let here = self.residuals.as_ref()?;
        let mut jacobian = DMatrix::zeros(here.len(), self.at.len());
        for k in 0..self.at.len() {
            // Inwards, so that the quotient's other end lies in the cube too.
            let step = if self.at[k] < 0.5 {
                self.step
            } else {
                -self.step
            };
            let mut beside = self.at.clone();
            beside[k] += step;
            let column = (self.run(&beside)? - here) / step;
            let on_wall = self.at[k] == 0.0 || self.at[k] == 1.0;
            // Downhill is against the gradient; off a wall it must lead inwards, as the step does.
            let leads_out = column.dot(here) * step > 0.0;
            if !(on_wall && leads_out) {
                jacobian.set_column(k, &column);
            }
        }
        Some(jacobian)
    }
}

impl Solver for LevenbergMarquardt {
    fn name(&self) -> &'static str {
        "lm"
    }

    fn search(&self, evaluator: &mut Evaluator<'_>, _seed: u64) {
        let start = evaluator
            .objective()
            .start()
            .unwrap_or_else(|| vec![0.5; evaluator.dim()]);
        let mut problem = Problem {
            evaluator: RefCell::new(evaluator),
            at: DVector::from_vec(start),
            residuals: None,
            step: self.step,
        };
        problem.residuals = problem.run(&problem.at);
        loop {
            let Some(before) = problem.residuals.as_ref().map(|r| r.norm_squared()) else {
                return;
            };
            let engine = Engine::new()
                .with_ftol(self.tolerance)
                .with_xtol(self.tolerance)
                .with_gtol(0.0);
            (problem, _) = engine.minimize(problem);
            let after = problem
                .residuals
                .as_ref()
                .map_or(f64::INFINITY, |r| r.norm_squared());
            if after.is_nan() || after >= before * (1.0 - self.worthwhile) {
                return;
            }
        }
    }
}
