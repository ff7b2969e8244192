//! Least squares without a list of residuals: a step of the search needs only a few numbers of a million of them.

use nalgebra::DMatrix;

/// An objective with its residuals in compressed form.
pub trait Compressed {
    /// Sum of squares of the residuals at a point, and the cost, from one evaluation; `None` where the model cannot run.
    fn squares_and_cost(&self, x: &[f64]) -> Option<(f64, f64)>;

    /// Residuals at a point and their changes to the `moved` points; `None` where the model cannot run at the point.
    fn tangent(&self, x: &[f64], moved: &[Vec<f64>]) -> Option<Tangent>;
}

/// Residuals at a point and their changes to other points, up to a rotation of the residual space.
#[derive(Clone, Debug)]
pub struct Tangent {
    /// Factor R of the QR decomposition, `(1 + m) × (1 + m)` for `m` other points, of the matrix with a row a residual: the
    /// residuals at the point in the first column, the changes to each other point in the next; zeros where that point
    /// has no model.
    pub triangle: DMatrix<f64>,
    /// Whether each of the other points has a model.
    pub possible: Vec<bool>,
}
