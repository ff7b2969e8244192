//! The curvature of the cost where the fit ends, and the standard deviations that follow from it.

use super::cholesky::Matrix;
use crate::fit::Point;
use crate::scalar::Real;

/// Inverse of half the curvature of the sum of squares over the unit cube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    pub(super) inverse: Matrix,
    pub(super) periods: f32,
}

impl Curvature {
    /// Standard deviation of a quantity that changes by `gradient` over the cube. `least` is the mean squared error, counts²;
    /// `readings` is how many readings of the trace say something new.
    pub fn std(&self, gradient: &Point, least: f32, readings: usize) -> f32 {
        let repeats = self.periods / readings.max(1) as f32;
        let mut variance = 0.0;
        for (row, &a) in self.inverse.iter().zip(gradient) {
            for (entry, &b) in row.iter().zip(gradient) {
                if a != 0.0 && b != 0.0 {
                    variance += entry * a * b;
                }
            }
        }
        Real::sqrt(least * repeats * variance.max(0.0))
    }
}
