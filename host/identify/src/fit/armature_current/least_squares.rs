//! Linear least squares of a few columns, with the sandwich over time segments for its errors.

use crate::fit::uncertainty::{few, independent, segments};
use nalgebra::{SMatrix, SVector};

/// Slopes over `N` columns.
pub struct LeastSquares<const N: usize> {
    /// Inverse of the columns' products.
    pub inverse: SMatrix<f64, N, N>,
    /// The slopes.
    pub slopes: SVector<f64, N>,
}

impl<const N: usize> LeastSquares<N> {
    /// The columns' products, and the slopes of the targets over them; a row of zeros with a target of zero counts for nothing. `None`
    /// where the columns are not independent, as `spans` judges of their products.
    pub fn through(
        rows: &[SVector<f64, N>],
        targets: &[f64],
        spans: impl Fn(&SMatrix<f64, N, N>) -> bool,
    ) -> Option<Self> {
        let mut squares = SMatrix::<f64, N, N>::zeros();
        let mut products = SVector::<f64, N>::zeros();
        for (row, &target) in rows.iter().zip(targets) {
            squares += row * row.transpose();
            products += row * target;
        }
        let inverse = squares.try_inverse().filter(|_| spans(&squares))?;
        let slopes = inverse * products;
        Some(LeastSquares { inverse, slopes })
    }

    /// Targets less what the slopes make of the rows.
    pub fn errors(&self, rows: &[SVector<f64, N>], targets: &[f64]) -> Vec<f64> {
        let pairs = rows.iter().zip(targets);
        pairs
            .map(|(row, target)| target - self.slopes.dot(row))
            .collect()
    }

    /// Covariance of the slopes where errors that are correlated over time count once a segment, as for the fit's parameters.
    pub fn sandwich(&self, rows: &[SVector<f64, N>], errors: &[f64]) -> SMatrix<f64, N, N> {
        let length = rows.len().div_ceil(segments(independent(errors))).max(1);
        let pairs = rows.chunks(length).zip(errors.chunks(length));
        let gradients: Vec<SVector<f64, N>> = pairs
            .map(|(rows, errors)| {
                rows.iter()
                    .zip(errors)
                    .map(|(row, error)| row * *error)
                    .sum()
            })
            .collect();
        let middle: SMatrix<f64, N, N> = gradients.iter().map(|g| g * g.transpose()).sum();
        self.inverse * (middle * few(gradients.len())) * self.inverse
    }
}
