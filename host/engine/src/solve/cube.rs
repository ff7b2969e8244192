//! The evaluator as a problem of the crate `basin`, whose methods take a problem that counts
//! nothing and can only be left by an error: [`Stop`] is that error.

use super::{Evaluator, Stop};
use basin::{BoxBounds, ConstraintDescription, ConstraintSet, Constraints, CostFunction};
use std::cell::{Cell, RefCell};

/// The cost that a method gets where the model is impossible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Impossible {
    /// Infinity, for methods that only compare costs.
    Infinite,
    /// Far above the worst finite cost so far, for methods that take differences of costs.
    FarAbove,
}

/// The unit cube with its cost. Points outside are clamped, which these methods never need.
pub(super) struct Cube<'s, 'a> {
    evaluator: RefCell<&'s mut Evaluator<'a>>,
    impossible: Impossible,
    worst: Cell<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl<'s, 'a> Cube<'s, 'a> {
    pub(super) fn new(evaluator: &'s mut Evaluator<'a>, impossible: Impossible) -> Self {
        let dim = evaluator.dim();
        Cube {
            evaluator: RefCell::new(evaluator),
            impossible,
            worst: Cell::new(0.0),
            lower: vec![0.0; dim],
            upper: vec![1.0; dim],
        }
    }
}

impl Constraints for Cube<'_, '_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        ConstraintSet::new().with_bounds(BoxBounds::new(Some(&self.lower), Some(&self.upper)))
    }
}

impl CostFunction for Cube<'_, '_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Stop;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Stop> {
        let cost = self.evaluator.borrow_mut().evaluate(x)?;
        if cost.is_finite() {
            self.worst.set(self.worst.get().max(cost.abs()));
        } else if self.impossible == Impossible::FarAbove {
            return Ok(1e3 * (1.0 + self.worst.get()));
        }
        Ok(cost)
    }
}
