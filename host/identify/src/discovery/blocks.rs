//! Regressions on all blocks of a recording but one, from the sums of products of each block.

use super::equation::Equation;
use nalgebra::{DMatrix, DVector};

/// Blocks of a recording.
const BLOCKS: usize = 16;
/// Ridge, parts of a column's square: what is dependent within rounding stays solvable.
const RIDGE: f64 = 1e-9;

/// Sums of products of a recording's columns: the model's own, then the missing volts, then the terms'.
pub struct Blocks {
    /// One matrix a block.
    parts: Vec<DMatrix<f64>>,
    /// Their sum.
    pub all: DMatrix<f64>,
    /// How many columns are the model's own.
    pub own: usize,
    /// Rows.
    pub rows: usize,
}

impl Blocks {
    /// Of the columns of terms.
    pub fn new(equation: &Equation<'_>, terms: &[&[f64]]) -> Self {
        let own = equation.own.len();
        let mut columns: Vec<&[f64]> = equation.own.iter().map(Vec::as_slice).collect();
        columns.push(&equation.missing);
        columns.extend(terms);
        let rows = equation.rows.len();
        let length = rows.div_ceil(BLOCKS);
        let parts: Vec<DMatrix<f64>> = (0..rows)
            .step_by(length)
            .map(|from| {
                let to = (from + length).min(rows);
                let block = DMatrix::from_fn(to - from, columns.len(), |k, j| columns[j][from + k]);
                block.transpose() * &block
            })
            .collect();
        let size = columns.len();
        let all = parts
            .iter()
            .fold(DMatrix::zeros(size, size), |sum, part| sum + part);
        Blocks {
            parts,
            all,
            own,
            rows,
        }
    }

    /// Columns of the model's own with those of terms.
    pub fn with(&self, terms: &[usize]) -> Vec<usize> {
        let terms = terms.iter().map(|term| self.own + 1 + term);
        (0..self.own).chain(terms).collect()
    }

    /// Coefficients of `columns` by all blocks.
    pub fn coefficients(&self, columns: &[usize]) -> Option<DVector<f64>> {
        solve(&self.of(&self.all, columns))
    }

    /// Squares that coefficients leave on all blocks.
    pub fn left(&self, columns: &[usize], by: &DVector<f64>) -> f64 {
        left(&self.of(&self.all, columns), by)
    }

    /// Squares that each block leaves where its coefficients come from the others.
    pub fn left_out(&self, columns: &[usize]) -> Option<f64> {
        let all = self.of(&self.all, columns);
        let mut sum = 0.0;
        for part in &self.parts {
            let part = self.of(part, columns);
            let by = solve(&(&all - &part))?;
            sum += left(&part, &by);
        }
        Some(sum)
    }

    /// Sums of products of some columns, with the missing volts as the last.
    fn of(&self, products: &DMatrix<f64>, columns: &[usize]) -> DMatrix<f64> {
        let place = |k: usize| columns.get(k).copied().unwrap_or(self.own);
        let size = columns.len() + 1;
        DMatrix::from_fn(size, size, |a, b| products[(place(a), place(b))])
    }
}

/// Coefficients of all columns but the last, which they make up.
fn solve(products: &DMatrix<f64>) -> Option<DVector<f64>> {
    let n = products.ncols() - 1;
    let scale = DVector::from_fn(n, |a, _| 1.0 / products[(a, a)].max(1e-300).sqrt());
    let mut matrix = DMatrix::from_fn(n, n, |a, b| products[(a, b)] * scale[a] * scale[b]);
    for k in 0..n {
        matrix[(k, k)] += RIDGE;
    }
    let right = DVector::from_fn(n, |a, _| products[(a, n)] * scale[a]);
    let by = matrix.cholesky()?.solve(&right).component_mul(&scale);
    by.iter().all(|x| x.is_finite()).then_some(by)
}

/// Squares that coefficients of all columns but the last leave of it.
fn left(products: &DMatrix<f64>, by: &DVector<f64>) -> f64 {
    let n = by.len();
    let mut sum = products[(n, n)];
    for a in 0..n {
        sum -= 2.0 * by[a] * products[(a, n)];
        for b in 0..n {
            sum += by[a] * by[b] * products[(a, b)];
        }
    }
    sum.max(0.0)
}
