//! A step in a short window of a residual, beside the smooth course that a slightly wrong model leaves.

use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// A polynomial with a step, fitted to a window.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    /// Height of the step, counts.
    pub height: f64,
    /// Sum of squares that is left.
    pub squares: f64,
    /// Largest that is left.
    pub largest: f64,
}

/// The window's polynomial of this degree with a step of free height just before sample `at`. `None` where
/// the window says too little.
pub fn with_step(y: &[f64], window: Range<usize>, at: usize, degree: usize) -> Option<Fitted> {
    beside(y, window, at, &[], degree)
}

/// The same beside steps of free heights at `others`, all of them inside the window and at different samples.
pub fn beside(
    y: &[f64],
    window: Range<usize>,
    at: usize,
    others: &[usize],
    degree: usize,
) -> Option<Fitted> {
    let (own, columns) = (degree + 1, degree + 2 + others.len());
    let value = |column: usize, k: usize, t: f64| match column.checked_sub(own) {
        None => t.powi(column as i32),
        Some(0) => f64::from(k >= at),
        Some(other) => f64::from(k >= others[other - 1]),
    };
    let (solution, squares, largest) = fitted(y, window, columns, value)?;
    Some(Fitted {
        height: solution[own],
        squares,
        largest,
    })
}

/// Sum of squares that a smooth course leaves: a polynomial of third degree.
pub fn smooth(y: &[f64], window: Range<usize>) -> Option<f64> {
    fitted(y, window, 4, |column, _, t| t.powi(column as i32)).map(|(_, squares, _)| squares)
}

/// Least squares over a window, whose time runs from −1 to 1: the solution, what it leaves in the sum of
/// squares and at most.
fn fitted(
    y: &[f64],
    window: Range<usize>,
    columns: usize,
    value: impl Fn(usize, usize, f64) -> f64,
) -> Option<(DVector<f64>, f64, f64)> {
    if window.len() <= columns {
        return None;
    }
    let (from, half) = (window.start as f64, 0.5 * (window.len() - 1) as f64);
    let time = |k: usize| (k as f64 - from) / half - 1.0;
    let matrix = DMatrix::from_fn(window.len(), columns, |row, column| {
        let k = window.start + row;
        value(column, k, time(k))
    });
    let right = DVector::from_column_slice(&y[window]);
    let solution = (matrix.transpose() * &matrix)
        .cholesky()?
        .solve(&(matrix.transpose() * &right));
    let left = right - matrix * &solution;
    Some((solution, left.norm_squared(), left.amax()))
}

/// The filter that estimates a step's height: what is orthogonal to every polynomial of a degree, over
/// `half` samples to each side of the step. Only its later half; the earlier one is its negative mirror image.
pub fn filter(half: usize, degree: usize) -> Vec<f64> {
    let time = |i: usize| (i as f64 + 0.5) / half as f64;
    // A step is odd, so that even powers are orthogonal to it already.
    let powers: Vec<i32> = (1..=degree as i32).step_by(2).collect();
    let matrix = DMatrix::from_fn(half, powers.len(), |i, j| time(i).powi(powers[j]));
    let step = DVector::from_element(half, 0.5);
    let normal = matrix.transpose() * &matrix;
    let shape = match normal.cholesky() {
        Some(cholesky) if !powers.is_empty() => {
            let smooth = cholesky.solve(&(matrix.transpose() * &step));
            &step - matrix * smooth
        }
        _ => step.clone(),
    };
    let norm = 2.0 * shape.dot(&step);
    shape.iter().map(|h| h / norm).collect()
}

/// The filter's output where the step would be just before sample `at`; `None` too near an end.
pub fn filtered(y: &[f64], at: usize, filter: &[f64]) -> Option<f64> {
    let half = filter.len();
    if at < half || at + half > y.len() {
        return None;
    }
    let later = y[at..at + half].iter();
    let earlier = y[at - half..at].iter().rev();
    Some(
        later
            .zip(earlier)
            .zip(filter)
            .map(|((later, earlier), h)| h * (later - earlier))
            .sum(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_on_any_cubic_is_found_with_its_height() {
        for half in [5, 16, 32] {
            for degree in [0, 1, 3] {
                let wave = |k: usize| -> f64 {
                    let t = k as f64 / 40.0;
                    (0..=degree).map(|d| t.powi(d as i32)).sum()
                };
                let at = 50;
                let step = |k: usize| if k >= at { 3.0 } else { 0.0 };
                let y: Vec<f64> = (0..100).map(|k| wave(k) + step(k)).collect();
                let window = at - half..at + half;
                let found = with_step(&y, window, at, degree).unwrap();
                let also = filtered(&y, at, &filter(half, degree)).unwrap();
                assert!((found.height - 3.0).abs() < 1e-6, "{half} {degree}");
                assert!((also - 3.0).abs() < 1e-6, "{half} {degree}: {also}");
                assert!(found.largest < 1e-6 && found.squares < 1e-9);
            }
        }
    }
}
