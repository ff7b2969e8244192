//! The same least-squares problem with compressed residuals: one row more than there are unknowns.
//!
//! A rotation of the residual space changes no step. So the residuals at a point may as well be `(‖r‖, 0, 0, …)`, which
//! is known before the Jacobian is asked for; the tangent's triangle is the Jacobian in that frame.

use super::super::{Compressed, Evaluator, Stop, Tangent};
use super::STEP;
use super::residuals::{Descended, IMPOSSIBLE};
use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::{DMatrix, DVector, Dyn, Owned};
use std::cell::{Cell, RefCell};

/// The evaluator as a least-squares problem over the whole space.
pub(super) struct Compact<'s, 'a> {
    compressed: &'a dyn Compressed,
    evaluator: RefCell<&'s mut Evaluator<'a>>,
    x: DVector<f64>,
    evaluated: Cell<bool>,
    met_wall: Cell<bool>,
}

impl<'s, 'a> Compact<'s, 'a> {
    pub(super) fn new(
        compressed: &'a dyn Compressed,
        evaluator: &'s mut Evaluator<'a>,
        x: DVector<f64>,
    ) -> Self {
        Compact {
            compressed,
            evaluator: RefCell::new(evaluator),
            x,
            evaluated: Cell::new(false),
            met_wall: Cell::new(false),
        }
    }

    /// The tangent at `x` with one step for each coordinate; the `new` ones are booked as evaluations.
    fn tangent(
        &self,
        x: &DVector<f64>,
        steps: &[f64],
        new: &[usize],
    ) -> Result<Option<Tangent>, Stop> {
        let moved: Vec<Vec<f64>> = steps
            .iter()
            .enumerate()
            .map(|(axis, step)| {
                let mut moved = x.as_slice().to_vec();
                moved[axis] += step;
                moved
            })
            .collect();
        let mut evaluator = self.evaluator.borrow_mut();
        if evaluator.left() < new.len() {
            return Err(Stop);
        }
        let tangent = self.compressed.tangent(x.as_slice(), &moved);
        for &axis in new {
            // A probe counts as an evaluation; its cost is too close to that at `x` to compete for the best.
            evaluator.record(&moved[axis], f64::INFINITY);
        }
        Ok(tangent)
    }

    fn differences(&self) -> Result<Option<DMatrix<f64>>, Stop> {
        let x = self.inside();
        let inwards = |x: &f64| if x + STEP > 1.0 { -STEP } else { STEP };
        let mut steps: Vec<f64> = x.iter().map(inwards).collect();
        let all: Vec<usize> = (0..steps.len()).collect();
        let Some(mut tangent) = self.tangent(&x, &steps, &all)? else {
            return Ok(None);
        };
        // Where there is no model on one side there may be one on the other.
        let reversed: Vec<usize> = all
            .into_iter()
            .filter(|&axis| !tangent.possible[axis])
            .filter(|&axis| (0.0..=1.0).contains(&(x[axis] - steps[axis])))
            .collect();
        if !reversed.is_empty() {
            for &axis in &reversed {
                steps[axis] = -steps[axis];
            }
            match self.tangent(&x, &steps, &reversed)? {
                Some(other) => tangent = other,
                None => return Ok(None),
            }
        }
        Ok(Some(self.jacobian_of(&tangent.triangle, &steps)))
    }

    fn jacobian_of(&self, triangle: &DMatrix<f64>, steps: &[f64]) -> DMatrix<f64> {
        let sign = 1.0f64.copysign(triangle[(0, 0)]);
        let mut jacobian = DMatrix::zeros(triangle.nrows(), steps.len());
        for (axis, step) in steps.iter().enumerate() {
            let column = triangle.column(axis + 1) * (sign / step);
            // The first row is the gradient. A coordinate at a wall is held where the cost does not fall inwards.
            let gradient = column[0];
            let at = self.x[axis];
            if (at <= 0.0 && gradient >= 0.0) || (at >= 1.0 && gradient <= 0.0) {
                self.met_wall.set(true);
            } else {
                jacobian.set_column(axis, &column);
            }
        }
        jacobian
    }
}

impl Descended for Compact<'_, '_> {
    fn inside(&self) -> DVector<f64> {
        self.x.map(|x| x.clamp(0.0, 1.0))
    }

    fn met_wall(&self) -> bool {
        self.met_wall.get()
    }

    fn evaluated(&self) -> bool {
        self.evaluated.get()
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Compact<'_, '_> {
    type ParameterStorage = Owned<f64, Dyn>;
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.x.copy_from(x);
    }

    fn params(&self) -> DVector<f64> {
        self.x.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        let inside = self.inside();
        if inside != self.x {
            self.met_wall.set(true);
        }
        let mut evaluator = self.evaluator.borrow_mut();
        let squares = evaluator.evaluate_squares(self.compressed, inside.as_slice());
        let length = match squares.ok()? {
            Some(squares) => squares.sqrt(),
            // At the start there is nothing to step back to.
            None if !self.evaluated() => return None,
            None => IMPOSSIBLE,
        };
        self.evaluated.set(true);
        let mut residuals = DVector::zeros(self.x.len() + 1);
        residuals[0] = length;
        Some(residuals)
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        self.differences().ok()?
    }
}
