//! How well the data determine the unknowns: from the Jacobian of the residuals, with the *effective*
//! number of independent samples.
//!
//! Quantisation errors of neighbouring samples are anything but independent (a motor at rest
//! repeats the same one a thousand times), so the textbook `σ²·(JᵀJ)⁻¹` is far too hopeful. The
//! covariance is the cluster-robust sandwich `H⁻¹·(Σ gₛ·gₛᵀ)·H⁻¹` over time segments s (White, 1980;
//! Liang, Zeger, 1986), where `gₛ` is a segment's part of the gradient: whatever the correlation
//! within a segment, it is counted once.

use super::memory::memory;
use crate::problem::{Data, FitProblem};
use nalgebra::{DMatrix, DVector};

/// Time segments that count as independent.
pub(super) const SEGMENTS: usize = 24;
/// Wanted RMS change of the residual for a difference quotient, counts: far above rounding, far
/// below any bend.
const PROBE_COUNTS: f64 = 0.02;
/// Singular values of the column-scaled Jacobian below this are directions that the data do not hold.
const FLAT: f64 = 1e-6;

/// Coordinates nearer than this to a wall of the cube lie on it.
const WALL: f64 = 1e-9;
/// Part of the squared error that one more step would remove, above which the search has not converged.
const UNCONVERGED: f64 = 0.2;

/// Covariance of the unknowns, and how many samples are worth counting.
#[derive(Clone, Debug)]
pub struct Uncertainty {
    /// Covariance in natural units; a row and a column for each unknown.
    pub covariance: DMatrix<f64>,
    /// Unknowns that the data do not determine at all (part of a flat direction).
    pub flat: Vec<bool>,
    /// Whether the search ended near enough to a minimum for errors to mean anything.
    pub converged: bool,
    /// Samples that the recording is worth, given how its residuals hang together.
    pub effective_samples: f64,
}

impl Uncertainty {
    /// Standard error of unknown `k`; `None` where the data do not determine it.
    pub fn std(&self, k: usize) -> Option<f64> {
        let variance = self.covariance[(k, k)];
        (self.converged && !self.flat[k] && variance.is_finite() && variance >= 0.0)
            .then(|| variance.sqrt())
    }
}

/// Jacobian of the residuals by central differences at `values`, one column an unknown.
pub fn jacobian(problem: &FitProblem<'_>, values: &[f64]) -> Option<DMatrix<f64>> {
    let run = |values: &[f64]| problem.errors(&problem.structure.candidate(values)).ok();
    let here = run(values)?;
    let mut jacobian = DMatrix::zeros(here.len(), values.len());
    for (k, unknown) in problem.structure.unknowns.iter().enumerate() {
        let (low, high) = unknown.range;
        let mut step = 1e-4 * values[k].abs().max(1e-4 * (high - low));
        let mut ahead = moved(values, k, step, high);
        // One correction of the step brings the change near the wanted size.
        let change = rms_difference(&run(&ahead)?, &here);
        if change > 0.0 {
            step = (step * (PROBE_COUNTS / change).clamp(1e-4, 1e3)).min(0.02 * (high - low));
            ahead = moved(values, k, step, high);
        }
        let behind = moved(values, k, -step, low);
        let width = ahead[k] - behind[k];
        if width == 0.0 {
            continue;
        }
        let (up, down) = (run(&ahead)?, run(&behind)?);
        for i in 0..here.len() {
            jacobian[(i, k)] = (up[i] - down[i]) / width;
        }
    }
    jacobian.iter().all(|x| x.is_finite()).then_some(jacobian)
}

/// `values` with unknown `k` moved by `step`, not beyond `limit`.
fn moved(values: &[f64], k: usize, step: f64, limit: f64) -> Vec<f64> {
    let mut values = values.to_vec();
    let target = values[k] + step;
    values[k] = if step > 0.0 {
        target.min(limit.max(values[k]))
    } else {
        target.max(limit.min(values[k]))
    };
    values
}

fn rms_difference(a: &[f64], b: &[f64]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / a.len().max(1) as f64).sqrt()
}

/// The sandwich covariance at `values`, where the residuals are `residuals`.
pub fn uncertainty(
    problem: &FitProblem<'_>,
    values: &[f64],
    residuals: &[f64],
) -> Option<Uncertainty> {
    let mut scaled = jacobian(problem, values)?;
    let (rows, columns) = scaled.shape();
    let scales: Vec<f64> = scaled.column_iter().map(|c| c.norm()).collect();
    for (mut column, &scale) in scaled.column_iter_mut().zip(&scales) {
        if scale > 0.0 {
            column /= scale;
        } else {
            column.fill(0.0);
        }
    }
    let hessian = scaled.tr_mul(&scaled);
    let eigen = hessian.symmetric_eigen();
    let mut inverse = DMatrix::zeros(columns, columns);
    let mut flat: Vec<bool> = scales.iter().map(|&s| s == 0.0).collect();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > FLAT * FLAT * columns as f64 {
            inverse += vector * vector.transpose() / *value;
        } else {
            for (k, share) in vector.iter().enumerate() {
                flat[k] |= share * share > 1e-3;
            }
        }
    }
    // How far the minimum still is, by one Gauss-Newton step. Away from it a standard error would
    // describe a place where nobody is: the distance counts as error too, and where most of the
    // error could still be removed there is nothing to state. Unknowns on a wall stay there.
    let residual_vector = DVector::from_column_slice(residuals);
    let mut gradient = scaled.tr_mul(&residual_vector);
    for (k, x) in problem.structure.coordinates(values).iter().enumerate() {
        if !(WALL..=1.0 - WALL).contains(x) {
            gradient[k] = 0.0;
        }
    }
    let away = -(&inverse * &gradient);
    let removable = gradient.dot(&(&inverse * &gradient))
        / residual_vector.norm_squared().max(f64::MIN_POSITIVE);

    let mut middle = DMatrix::zeros(columns, columns);
    let per_segment = rows.div_ceil(SEGMENTS).max(1);
    for from in (0..rows).step_by(per_segment) {
        let to = (from + per_segment).min(rows);
        let mut gradient = DVector::zeros(columns);
        for (row, residual) in scaled.row_iter().zip(residuals).take(to).skip(from) {
            gradient += row.transpose() * *residual;
        }
        middle += &gradient * gradient.transpose();
    }
    let segments = rows.div_ceil(per_segment) as f64;
    let correction = segments / (segments - (columns as f64).min(segments - 1.0));
    let scaled_covariance = &inverse * middle * &inverse * correction + &away * away.transpose();
    let covariance = DMatrix::from_fn(columns, columns, |i, k| {
        let scale = scales[i] * scales[k];
        if scale > 0.0 {
            scaled_covariance[(i, k)] / scale
        } else {
            f64::INFINITY
        }
    });
    Some(Uncertainty {
        covariance,
        flat,
        converged: removable < UNCONVERGED,
        effective_samples: effective_samples(problem.data, residuals),
    })
}

/// Samples divided by the sum of the residuals' autocorrelation ([`memory`]), and never more than the changes of the reading.
pub fn effective_samples(data: &Data, residuals: &[f64]) -> f64 {
    let n = residuals.len();
    let mean = residuals.iter().sum::<f64>() / n.max(1) as f64;
    let product = |lag: usize| -> f64 {
        residuals[..n - lag]
            .iter()
            .zip(&residuals[lag..])
            .map(|(a, b)| (a - mean) * (b - mean))
            .sum()
    };
    let variance = product(0);
    if n < 2 || variance <= 0.0 {
        return n as f64;
    }
    let sum = memory(n / 2, |lag| product(lag) / variance);
    let independent = n as f64 / (1.0 + 2.0 * sum);
    if data.quantised {
        independent.min(data.transitions().max(1) as f64)
    } else {
        independent
    }
}
