//! Least squares without lists of residuals: what a step of the search needs of a million of them are a few numbers.

use nalgebra::DMatrix;

/// An objective whose residuals can be had compressed.
pub trait Compressed {
    /// Sum of squares of the residuals at a point, and the cost, from one and the same evaluation; `None` where there is
    /// none.
    fn squares_and_cost(&self, x: &[f64]) -> Option<(f64, f64)>;

    /// What the residuals do about a point; `None` where there are none at the point itself.
    fn tangent(&self, x: &[f64], moved: &[Vec<f64>]) -> Option<Tangent>;
}

/// The residuals at a point, and by how much they differ at others.
#[derive(Clone, Debug)]
pub struct Tangent {
    /// The triangle of the orthogonal decomposition of a matrix with a row a residual: its first column are the residuals
    /// at the point, each further one the changes to another. A column of zeros where there is no model.
    pub triangle: DMatrix<f64>,
    /// Whether there is a model at each of the others.
    pub possible: Vec<bool>,
}
