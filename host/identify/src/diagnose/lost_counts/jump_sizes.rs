//! The heights of all jumps at once, beside a shift of the parameters.

use super::settings::{RIGHT, SIZES_DAMPING};
use crate::diagnose::models::Loss;
use nalgebra::{DMatrix, DVector};

/// The losses with the heights that explain `y`, model minus reading, together with any amounts of the
/// `columns` and a constant; those that are nearer to none than to one count dropped. A drift that looked like
/// a small jump is then the parameters' again. None are touched where even that leaves too much.
pub fn rounded(y: &[f64], columns: &[Vec<f64>], losses: Vec<Loss>) -> Vec<Loss> {
    let samples = y.len();
    let smooth = columns.len() + 1;
    let n = smooth + losses.len();
    let from = |i: usize| i.checked_sub(smooth).map_or(0, |loss| losses[loss].sample);
    // Of a jump and anything else the product is a sum from the jump on.
    let tails: Vec<Vec<f64>> = columns.iter().map(|c| sums(c)).collect();
    let own = sums(y);
    let product = |i: usize, j: usize| -> f64 {
        let at = from(i).max(from(j));
        match (i < smooth - 1, j < smooth - 1) {
            (true, true) => columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum(),
            (true, false) => tails[i][at],
            (false, true) => tails[j][at],
            (false, false) => (samples - at) as f64,
        }
    };
    let mut normal = DMatrix::from_fn(n, n, |i, j| if j < i { 0.0 } else { product(i, j) });
    normal.fill_lower_triangle_with_upper_triangle();
    for i in 0..n {
        normal[(i, i)] *= 1.0 + SIZES_DAMPING;
    }
    let right = DVector::from_fn(n, |i, _| {
        if i < smooth - 1 {
            columns[i].iter().zip(y).map(|(a, b)| a * b).sum()
        } else {
            own[from(i)]
        }
    });
    let Some(cholesky) = normal.cholesky() else {
        return losses;
    };
    let solution = cholesky.solve(&right);
    let squares = y.iter().map(|v| v * v).sum::<f64>() - right.dot(&solution);
    if squares.is_nan() || squares >= RIGHT * RIGHT * samples as f64 {
        return losses;
    }
    let heights = solution.iter().skip(smooth);
    losses
        .iter()
        .zip(heights)
        .map(|(loss, height)| Loss {
            sample: loss.sample,
            counts: height.round(),
        })
        .filter(|loss| loss.counts != 0.0)
        .collect()
}

/// Sums from each sample to the end.
fn sums(values: &[f64]) -> Vec<f64> {
    let mut sums = values.to_vec();
    for k in (0..sums.len().saturating_sub(1)).rev() {
        sums[k] += sums[k + 1];
    }
    sums
}
