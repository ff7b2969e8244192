//! The residual without what a shift of the parameters can do.
//!
//! Lost counts bend a fit: the parameters follow the steps. To first order what they do is a sum of the
//! Jacobian's columns. From one sample to the next few a loss touches one difference in some hundred, so a sum
//! of absolute differences is blind to it, and finds the shift that takes the bend back.

use super::settings::{DAMPING, INFLUENCE_ROUNDS, QUANTUM, STEP};
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::FitProblem;
use servoid_engine::solve::Objective;

/// Model minus reading, and how the parameters change it.
pub struct FitInfluence {
    /// Model minus reading at each sample, counts.
    pub residual: Vec<f64>,
    /// Columns of its Jacobian, each of unit size from sample to sample; those that do nothing left out.
    pub columns: Vec<Vec<f64>>,
}

impl FitInfluence {
    /// At `x`; `None` where the model cannot run.
    pub fn at(problem: &FitProblem<'_>, x: &[f64]) -> Option<Self> {
        let (residual, _) = problem.residuals_and_cost(x)?;
        let columns = columns(problem, x, &residual);
        Some(FitInfluence { residual, columns })
    }

    /// The residual less what a shift of the parameters does, by differences over `lag` samples: few where losses are
    /// many, many where few are left, since long ones see a small drift.
    pub fn without_influence(&self, lag: usize) -> Vec<f64> {
        let mut residual = self.residual.clone();
        let shift = shift(&residual, &self.columns, lag);
        for (shift, column) in shift.iter().zip(&self.columns) {
            for (residual, slope) in residual.iter_mut().zip(column) {
                *residual += shift * slope;
            }
        }
        residual
    }
}

fn columns(problem: &FitProblem<'_>, x: &[f64], here: &[f64]) -> Vec<Vec<f64>> {
    (0..x.len())
        .filter_map(|axis| {
            let mut moved = x.to_vec();
            moved[axis] += if moved[axis] + STEP > 1.0 {
                -STEP
            } else {
                STEP
            };
            let (there, _) = problem.residuals_and_cost(&moved)?;
            let mut column: Vec<f64> = there.iter().zip(here).map(|(t, h)| t - h).collect();
            let size = column
                .windows(2)
                .map(|p| (p[1] - p[0]).powi(2))
                .sum::<f64>();
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            column.iter_mut().for_each(|c| *c /= size.sqrt());
            Some(column)
        })
        .collect()
}

/// Amounts of the columns that make the sum of the absolute differences least (iteratively reweighted least
/// squares).
fn shift(residual: &[f64], columns: &[Vec<f64>], lag: usize) -> Vec<f64> {
    let difference = |values: &[f64]| -> Vec<f64> {
        values
            .windows(lag + 1)
            .map(|window| window[lag] - window[0])
            .collect()
    };
    let steps = difference(residual);
    let columns: Vec<Vec<f64>> = columns.iter().map(|c| difference(c)).collect();
    let n = columns.len();
    let mut shift = vec![0.0; n];
    for _ in 0..INFLUENCE_ROUNDS {
        let mut left = steps.clone();
        for (shift, column) in shift.iter().zip(&columns) {
            for (left, slope) in left.iter_mut().zip(column) {
                *left += shift * slope;
            }
        }
        let weights: Vec<f64> = left.iter().map(|r| 1.0 / r.abs().max(QUANTUM)).collect();
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter()
                .zip(b)
                .zip(&weights)
                .map(|((a, b), w)| a * b * w)
                .sum()
        };
        let mut normal = DMatrix::from_fn(n, n, |i, j| {
            if j < i {
                0.0
            } else {
                product(&columns[i], &columns[j])
            }
        });
        normal.fill_lower_triangle_with_upper_triangle();
        for i in 0..n {
            normal[(i, i)] *= 1.0 + DAMPING;
        }
        let right = DVector::from_fn(n, |i, _| -product(&columns[i], &steps));
        let Some(cholesky) = normal.cholesky() else {
            break;
        };
        shift = cholesky.solve(&right).iter().copied().collect();
    }
    shift
}
