//! Inverse of a small symmetric matrix, by Cholesky's method without roots (`L·D·Lᵀ`).

use super::MOST;

/// A matrix over the unknowns.
pub(super) type Matrix = [[f32; MOST]; MOST];

/// A pivot that is no more than this part of its diagonal is rounding.
const SINGULAR: f32 = 1e-6;

/// Inverse of a symmetric matrix of `n` rows whose diagonal is enlarged by the fraction `damping`, for the `free`
/// coordinates; `None` if it is not positive definite.
pub(super) fn inverse(
    matrix: &Matrix,
    n: usize,
    damping: f32,
    free: &[bool; MOST],
) -> Option<Matrix> {
    let entry = |a: usize, b: usize| match (free[a] && free[b], a == b) {
        (true, true) => matrix[a][a] * (1.0 + damping),
        (true, false) => matrix[a][b],
        (false, same) => f32::from(u8::from(same)),
    };
    let (mut lower, mut pivots) = ([[0.0; MOST]; MOST], [0.0; MOST]);
    for a in 0..n {
        for b in 0..=a {
            let terms = (0..b).map(|k| lower[a][k] * lower[b][k] * pivots[k]);
            let rest = terms.fold(entry(a, b), |rest, term: f32| rest - term);
            if a != b {
                lower[a][b] = rest / pivots[b];
            } else if rest > SINGULAR * entry(a, a) && rest.is_finite() {
                pivots[a] = rest;
            } else {
                return None;
            }
        }
    }
    let mut inverse = [[0.0; MOST]; MOST];
    for column in 0..n {
        let mut x = [0.0f32; MOST];
        for a in 0..n {
            let terms = (0..a).map(|k| lower[a][k] * x[k]);
            let unit = f32::from(u8::from(a == column));
            x[a] = terms.fold(unit, |rest, term| rest - term);
        }
        for a in (0..n).rev() {
            let terms = (a + 1..n).map(|k| lower[k][a] * x[k]);
            x[a] = terms.fold(x[a] / pivots[a], |rest, term| rest - term);
        }
        for (row, x) in inverse.iter_mut().zip(x) {
            row[column] = x;
        }
    }
    Some(inverse)
}
