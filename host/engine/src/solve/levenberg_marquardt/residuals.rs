//! The evaluator as the problem that the crate `levenberg-marquardt` solves.

use super::super::{Evaluator, Stop};
use super::STEP;
use levenberg_marquardt::LeastSquaresProblem;
use nalgebra::{DMatrix, DVector, Dyn, Owned};
use std::cell::{Cell, RefCell};

/// Residual where the model is impossible: so large that the step is refused.
pub(super) const IMPOSSIBLE: f64 = 1e100;

/// A problem after it has been descended on.
pub(super) trait Descended {
    /// The point, projected onto the cube.
    fn inside(&self) -> DVector<f64>;
    /// Whether a step or a coordinate was held back by the cube.
    fn met_wall(&self) -> bool;
    /// Whether there were residuals anywhere.
    fn evaluated(&self) -> bool;
}

/// The evaluator as a least-squares problem over the whole space.
pub(super) struct Residuals<'s, 'a> {
    evaluator: RefCell<&'s mut Evaluator<'a>>,
    x: DVector<f64>,
    /// Residuals at `x`, kept for the Jacobian, which is only asked for where a step has ended.
    here: RefCell<DVector<f64>>,
    met_wall: Cell<bool>,
}

impl<'s, 'a> Residuals<'s, 'a> {
    pub(super) fn new(evaluator: &'s mut Evaluator<'a>, x: DVector<f64>) -> Self {
        Residuals {
            evaluator: RefCell::new(evaluator),
            x,
            here: RefCell::new(DVector::zeros(0)),
            met_wall: Cell::new(false),
        }
    }

    fn at(&self, x: &DVector<f64>) -> Result<Option<DVector<f64>>, Stop> {
        let residuals = self
            .evaluator
            .borrow_mut()
            .evaluate_residuals(x.as_slice())?;
        Ok(residuals.map(DVector::from_vec))
    }

    /// Residuals with coordinate `axis` moved by `step`; `None` outside the cube or where the model
    /// is impossible.
    fn moved(
        &self,
        x: &DVector<f64>,
        axis: usize,
        step: f64,
    ) -> Result<Option<DVector<f64>>, Stop> {
        let mut moved = x.clone();
        moved[axis] += step;
        if (0.0..=1.0).contains(&moved[axis]) {
            self.at(&moved)
        } else {
            Ok(None)
        }
    }

    /// Derivative of the residuals by coordinate `axis`; zero where it cannot be had.
    fn column(&self, x: &DVector<f64>, axis: usize) -> Result<DVector<f64>, Stop> {
        let here = self.here.borrow();
        if let Some(above) = self.moved(x, axis, STEP)? {
            return Ok((above - &*here) / STEP);
        }
        let below = self.moved(x, axis, -STEP)?;
        Ok(below.map_or_else(
            || DVector::zeros(here.len()),
            |below| (&*here - below) / STEP,
        ))
    }

    /// Whether coordinate `axis` stands at a wall, or beyond, and the cost does not fall inwards.
    fn held(&self, axis: usize, column: &DVector<f64>) -> bool {
        let gradient = column.dot(&self.here.borrow());
        (self.x[axis] <= 0.0 && gradient >= 0.0) || (self.x[axis] >= 1.0 && gradient <= 0.0)
    }

    fn finite_differences(&self) -> Result<DMatrix<f64>, Stop> {
        let x = self.inside();
        let mut jacobian = DMatrix::zeros(self.here.borrow().len(), x.len());
        for axis in 0..x.len() {
            let column = self.column(&x, axis)?;
            if self.held(axis, &column) {
                self.met_wall.set(true);
            } else {
                jacobian.set_column(axis, &column);
            }
        }
        Ok(jacobian)
    }
}

impl Descended for Residuals<'_, '_> {
    fn inside(&self) -> DVector<f64> {
        self.x.map(|x| x.clamp(0.0, 1.0))
    }

    fn met_wall(&self) -> bool {
        self.met_wall.get()
    }

    fn evaluated(&self) -> bool {
        !self.here.borrow().is_empty()
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Residuals<'_, '_> {
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
        let mut here = self.here.borrow_mut();
        match self.at(&inside).ok()? {
            Some(residuals) => *here = residuals,
            // At the start there is nothing to step back to.
            None if here.is_empty() => return None,
            None => here.fill(IMPOSSIBLE),
        }
        Some(here.clone())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        self.finite_differences().ok()
    }
}
