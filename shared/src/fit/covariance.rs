//! How far the estimates may be off, where a fit ends.
//!
//! With the curvature `H` of half the sum of squares and the slopes `g_k` of the errors of `K` blocks of the trace, the covariance is the larger
//! of two, direction by direction: `σ²·H⁻¹`, which is right if what is left is the encoder's, and `K/(K − d)·H⁻¹·Σ g_k·g_kᵀ·H⁻¹`, which is right
//! also if what is left lasts, as what a model lacks does (Huber 1967; White, *Econometrica* 48, 1980; by blocks: Liang and Zeger, *Biometrika*
//! 73, 1986). A coordinate that the trace does not determine is known by its range.

use super::cholesky::{Matrix, inverse};
use super::differences::BLOCKS;
use super::{MOST, Point};
use crate::scalar::Real;

/// Standard deviation of a coordinate that nothing is known of, in the unit cube: as of numbers drawn from all of it.
const UNKNOWN: f32 = 0.3;

/// What rounding may take of a curvature, as a part of it.
const ROUNDING: f32 = 1e-5;

/// Covariance of the coordinates where a fit ends, in the unit cube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covariance {
    /// Whether there is one.
    known: bool,
    /// By the curvature.
    curvature: Matrix,
    /// By the scatter of the blocks.
    scatter: Matrix,
}

impl Covariance {
    /// Of nothing known.
    pub(super) const NONE: Self = Covariance {
        known: false,
        curvature: [[0.0; MOST]; MOST],
        scatter: [[0.0; MOST]; MOST],
    };

    /// Of `n` coordinates by their curvature and by the scatter of the blocks' slopes, with the variance of a reading, counts².
    pub(super) fn set(&mut self, n: usize, curvature: &Matrix, scatter: &Matrix, variance: f32) {
        *self = Self::NONE;
        let mut bounded = *curvature;
        for (k, row) in bounded.iter_mut().enumerate().take(n) {
            row[k] += variance / (UNKNOWN * UNKNOWN);
        }
        let Some(inverse) = inverse(&bounded, n, ROUNDING, &[true; MOST]) else {
            return;
        };
        self.known = true;
        let few = BLOCKS as f32 / (BLOCKS.saturating_sub(n)).max(1) as f32;
        for a in 0..n {
            let mut row = [0.0; MOST];
            for (c, sum) in row.iter_mut().enumerate().take(n) {
                *sum = (0..n).fold(0.0, |sum, k| sum + inverse[a][k] * scatter[k][c]);
            }
            for (b, beside) in inverse[a].iter().enumerate().take(n) {
                let sum = (0..n).fold(0.0, |sum, k| sum + row[k] * inverse[k][b]);
                self.scatter[a][b] = few * sum;
                self.curvature[a][b] = variance * beside;
            }
        }
    }

    /// Standard deviation of a quantity that changes by `gradient` over the cube; infinite if nothing is known of it.
    pub fn std(&self, gradient: &Point) -> f32 {
        if !self.known {
            return f32::INFINITY;
        }
        let by_scatter = variance(&self.scatter, gradient);
        Real::sqrt(by_scatter.max(variance(&self.curvature, gradient)))
    }

    /// The same by the curvature alone.
    pub(super) fn curvature_std(&self, gradient: &Point) -> f32 {
        Real::sqrt(variance(&self.curvature, gradient))
    }

    /// The move of all coordinates by which coordinate `k` of the first two moves by one, the other not at all, and the rest as the recording
    /// wants it.
    pub(super) fn along(&self, k: usize) -> Point {
        let [first, second] = [self.curvature[0], self.curvature[1]];
        let determinant = first[0] * second[1] - first[1] * second[0];
        let weights = match k {
            0 => [second[1], -first[1]],
            _ => [-second[0], first[0]],
        };
        let mut along = [0.0; MOST];
        along[k] = 1.0;
        if determinant > 0.0 {
            for (j, x) in along.iter_mut().enumerate().skip(2) {
                *x = (weights[0] * first[j] + weights[1] * second[j]) / determinant;
            }
        }
        along
    }
}

/// Variance of a quantity that changes by `gradient`.
fn variance(matrix: &Matrix, gradient: &Point) -> f32 {
    let mut variance = 0.0;
    for (row, &a) in matrix.iter().zip(gradient) {
        for (entry, &b) in row.iter().zip(gradient) {
            if a != 0.0 && b != 0.0 {
                variance += entry * a * b;
            }
        }
    }
    variance.max(0.0)
}
