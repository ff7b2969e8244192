//! Covariance of the unknowns from the Jacobian of the residuals, and the *effective* number of independent
//! samples.
//!
//! Quantisation errors of neighbouring samples are anything but independent (a motor at rest
//! repeats the same one a thousand times), so the textbook `σ²·(JᵀJ)⁻¹` is far too hopeful. The
//! covariance is the cluster-robust sandwich `H⁻¹·(Σ gₛ·gₛᵀ)·H⁻¹` over time segments s (White, 1980;
//! Liang, Zeger, 1986), where `gₛ` is a segment's part of the gradient: whatever the correlation
//! within a segment, it is counted once.
//!
//! That fails in two ways. Where a few segments hold all the information, the fit has made their gradients vanish; and
//! where the excitation repeats itself, so do the rounding errors, coherent across segments. So errors are drawn again that the fitted
//! path may as well have had (a bootstrap, Efron and Tibshirani, 1993): the rounding errors that the counter makes of the fitted path,
//! over all places of the path in its cell, and the residuals at other times, shifted around the end (the circular
//! bootstrap of a series that is correlated for long: Politis and Romano, 1992). The covariance is in no direction below the one that either makes.

use super::correlation_time::correlation_sum;
use super::sensitivity::{SEGMENTS, Sensitivity, sensitivity};
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::{Data, FitProblem};
use shared::error::ModelError;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Singular values of the column-scaled Jacobian below this belong to directions that the data do not determine.
const FLAT: f64 = 1e-6;

/// Independent samples to a segment, at least.
const INDEPENDENT: f64 = 4.0;
/// Half of the 95 % interval of a normal distribution, standard deviations.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// Variances below this part of the largest are rounding errors of the arithmetic.
const ROUNDED: f64 = 1e-14;
/// Stands for a variance without end.
const VERY_LARGE: f64 = 1e30;
/// Coordinates nearer than this to a wall of the cube lie on it.
const WALL: f64 = 1e-9;
/// Part of the squared error that one more step would remove, above which the search has not converged.
const UNCONVERGED: f64 = 0.2;

/// Covariance of the unknowns, and the effective number of samples.
#[derive(Clone, Debug)]
pub struct Uncertainty {
    /// Covariance in natural units; a row and a column for each unknown.
    pub covariance: DMatrix<f64>,
    /// Unknowns that the data do not determine at all (part of a flat direction).
    pub flat: Vec<bool>,
    /// Whether the search ended near enough to a minimum for errors to mean anything.
    pub converged: bool,
    /// Effective number of independent samples, from the residuals' autocorrelation.
    pub effective_samples: f64,
}

impl Uncertainty {
    /// The covariance in finite numbers, to be multiplied by slopes: an unknown without influence has an infinite variance, which
    /// is a very large one here.
    pub fn finite_covariance(&self) -> DMatrix<f64> {
        self.covariance.map(|entry| entry.min(VERY_LARGE))
    }

    /// Standard error of unknown `k`; `None` where the data do not determine it.
    pub fn std(&self, k: usize) -> Option<f64> {
        let variance = self.covariance[(k, k)];
        (self.converged && !self.flat[k] && variance.is_finite() && variance >= 0.0)
            .then(|| variance.sqrt())
    }
}

/// The covariance at `values`, SI. `None` where a model beside them cannot run.
///
/// # Errors
/// Where the model itself cannot run.
pub fn uncertainty(
    problem: &FitProblem<'_>,
    values: &[f64],
) -> Result<Option<Uncertainty>, ModelError> {
    let residuals = residuals(problem, values)?;
    Ok(covariance(problem, values, &residuals))
}

/// Errors of the model with these values from the centres of the cells, counts.
///
/// # Errors
/// Where the model cannot run.
pub(super) fn residuals(problem: &FitProblem<'_>, values: &[f64]) -> Result<Vec<f64>, ModelError> {
    let mut residuals = problem.errors(&problem.structure.candidate(values))?;
    let centre = problem.data.half_cell();
    for residual in &mut residuals {
        *residual -= centre;
    }
    Ok(residuals)
}

/// The same where the errors from the centres of the cells are `residuals`, counts.
fn covariance(problem: &FitProblem<'_>, values: &[f64], residuals: &[f64]) -> Option<Uncertainty> {
    let found = sensitivity(problem, values, residuals)?;
    let x = problem.structure.coordinates(values);
    let squares = residuals.iter().map(|r| r * r).sum();
    let effective = effective_samples(problem.data, residuals);
    Some(solve(&found, &x, squares, effective))
}

/// Covariance from the sums over the Jacobian `found` at the point `x` of the unit cube, where the residuals' squares sum to
/// `squares` and are worth so many independent ones.
pub(super) fn solve(
    found: &Sensitivity,
    x: &[f64],
    squares: f64,
    effective_samples: f64,
) -> Uncertainty {
    solve_above(found, x, squares, effective_samples, false)
}

/// The same; where `likelihood` says that the squares are the curvature of one, in no direction below its inverse.
fn solve_above(
    found: &Sensitivity,
    x: &[f64],
    squares: f64,
    effective_samples: f64,
    likelihood: bool,
) -> Uncertainty {
    let columns = x.len();
    let Inverse {
        scales,
        per_scale,
        inverse,
        flat,
    } = inverse(&found.squares);
    let scaled = |gradient: &DVector<f64>| gradient.component_mul(&per_scale);
    // Distance to the minimum, by one Gauss-Newton step. It counts as error too; where the step would remove
    // much of the squared error, no standard error is stated. Unknowns on a wall stay there.
    let gradient = scaled(&free_gradient(found, x));
    let away = -(&inverse * &gradient);
    let removable = gradient.dot(&(&inverse * &gradient)) / squares.max(f64::MIN_POSITIVE);

    let joined = joined(&found.gradients, segments(effective_samples));
    let mut middle = DMatrix::zeros(columns, columns);
    for gradient in joined.iter().map(scaled) {
        middle += &gradient * gradient.transpose();
    }
    let fine = found.gradients.len() as f64;
    let correction = fine / (fine - (columns as f64).min(fine - 1.0)) * few(joined.len());
    let sandwich = &inverse * middle * &inverse * correction + &away * away.transpose();
    let drawn = |gradients: &Vec<DVector<f64>>| {
        let mut middle = DMatrix::zeros(columns, columns);
        for gradient in gradients.iter().map(scaled) {
            middle += &gradient * gradient.transpose() / gradients.len() as f64;
        }
        &inverse * middle * &inverse
    };
    let own = likelihood.then(|| inverse.clone());
    let scaled_covariance = (found.redrawn.iter().map(drawn).chain(own))
        .fold(sandwich, |covariance, drawn| not_below(&covariance, &drawn));
    let covariance = DMatrix::from_fn(columns, columns, |i, k| {
        let scale = scales[i] * scales[k];
        match (scale > 0.0, i == k) {
            (true, _) => scaled_covariance[(i, k)] / scale,
            (false, true) => f64::INFINITY,
            // What nothing determines is correlated with nothing.
            (false, false) => 0.0,
        }
    });
    Uncertainty {
        covariance,
        flat,
        converged: removable < UNCONVERGED,
        effective_samples,
    }
}

/// Covariance from a likelihood's curvature and its gradient over time segments: the sandwich of the segments, which holds what a
/// misfit repeats within one, and in no direction below the curvature's.
pub(super) fn likely(found: &Sensitivity, effective_samples: f64) -> Uncertainty {
    let inside = vec![0.5; found.squares.ncols()];
    // One step may lower minus the logarithm by so much before the search counts as ended too early.
    solve_above(found, &inside, 1.0, effective_samples, true)
}

/// How far each unknown moves when the residuals change by the series of which `found` has the sums: one Gauss-Newton step from
/// the point `x` of the unit cube, in which those that are `held` and those on a wall stay. Flat directions are not followed.
pub(super) fn step(found: &Sensitivity, x: &[f64], held: &[bool]) -> DVector<f64> {
    let mut squares = found.squares.clone();
    for k in (0..held.len()).filter(|&k| held[k]) {
        squares.row_mut(k).fill(0.0);
        squares.column_mut(k).fill(0.0);
    }
    let Inverse {
        per_scale, inverse, ..
    } = inverse(&squares);
    let gradient = free_gradient(found, x).component_mul(&per_scale);
    -(inverse * gradient).component_mul(&per_scale)
}

/// Gradient of half the sum of squares in the directions that are not held by a wall.
fn free_gradient(found: &Sensitivity, x: &[f64]) -> DVector<f64> {
    let mut gradient: DVector<f64> = found.gradients.iter().sum();
    for (k, x) in x.iter().enumerate() {
        if !(WALL..=1.0 - WALL).contains(x) {
            gradient[k] = 0.0;
        }
    }
    gradient
}

/// The inverse of Jᵀ·J where J determines it.
struct Inverse {
    /// Lengths of the columns.
    scales: DVector<f64>,
    /// Their inverses; zero for a column of zeros.
    per_scale: DVector<f64>,
    /// Of the matrix with columns of length one.
    inverse: DMatrix<f64>,
    /// Unknowns with a part in a flat direction.
    flat: Vec<bool>,
}

fn inverse(squares: &DMatrix<f64>) -> Inverse {
    let columns = squares.ncols();
    let scales = squares.diagonal().map(|square| square.max(0.0).sqrt());
    let per_scale = scales.map(|scale| if scale > 0.0 { 1.0 / scale } else { 0.0 });
    let hessian = DMatrix::from_fn(columns, columns, |i, k| {
        squares[(i, k)] * per_scale[i] * per_scale[k]
    });
    let eigen = hessian.symmetric_eigen();
    let mut inverse = DMatrix::zeros(columns, columns);
    let mut flat: Vec<bool> = scales.iter().map(|&s| s == 0.0).collect();
    let vectors = eigen.eigenvectors.column_iter();
    for (value, vector) in eigen.eigenvalues.iter().zip(vectors) {
        if *value > FLAT * FLAT * columns as f64 {
            inverse += vector * vector.transpose() / *value;
        } else {
            for (k, share) in vector.iter().enumerate() {
                flat[k] |= share * share > 1e-3;
            }
        }
    }
    Inverse {
        scales,
        per_scale,
        inverse,
        flat,
    }
}

/// Into how many segments a recording that is worth so many independent samples is cut: each must be long beside the time for which
/// an error is correlated with itself.
pub(super) fn segments(effective_samples: f64) -> usize {
    let most = effective_samples / INDEPENDENT;
    let parts = [1, 2, 3, 4, 6].map(|part| SEGMENTS / part);
    (parts.into_iter())
        .find(|&count| count as f64 <= most)
        .unwrap_or(SEGMENTS / 6)
}

/// Sums of neighbours, so that about `count` are left.
fn joined(gradients: &[DVector<f64>], count: usize) -> Vec<DVector<f64>> {
    let length = gradients.len().div_ceil(count.max(1)).max(1);
    gradients
        .chunks(length)
        .map(|some| some.iter().sum())
        .collect()
}

/// Factor on a variance that is estimated from so few segments: of the estimate itself, and of Student's distribution whose 95 %
/// interval is wider than the normal one.
pub(super) fn few(segments: usize) -> f64 {
    let freedom = (segments as f64 - 1.0).max(1.0);
    let wider = StudentsT::new(0.0, 1.0, freedom).map_or(1.0, |t| t.inverse_cdf(0.975) / NORMAL_95);
    segments as f64 / freedom * wider * wider
}

/// A covariance that is in no direction below `a` or `b`: `a`, and what `b` has beyond it in the metric of their sum.
fn not_below(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let sum = (a + b).symmetric_eigen();
    let largest = sum.eigenvalues.iter().copied().fold(0.0, f64::max);
    let powered = |power: f64| {
        let values = sum.eigenvalues.map(|value| {
            if value > ROUNDED * largest {
                libm::pow(value, power)
            } else {
                0.0
            }
        });
        &sum.eigenvectors * DMatrix::from_diagonal(&values) * sum.eigenvectors.transpose()
    };
    let (root, inverse_root) = (powered(0.5), powered(-0.5));
    let beyond = (&inverse_root * (b - a) * &inverse_root).symmetric_eigen();
    let values = DMatrix::from_diagonal(&beyond.eigenvalues.map(|value| value.max(0.0)));
    let beyond = &beyond.eigenvectors * values * beyond.eigenvectors.transpose();
    a + &root * beyond * &root
}

/// Samples divided by the sum of the residuals' autocorrelation ([`correlation_sum`]), and never more than the changes of the reading.
pub fn effective_samples(data: &Data, residuals: &[f64]) -> f64 {
    let independent = independent(residuals);
    if data.quantised {
        independent.min(data.transitions().max(1) as f64)
    } else {
        independent
    }
}

/// How many independent errors these are worth.
pub(super) fn independent(errors: &[f64]) -> f64 {
    let n = errors.len();
    let mean = errors.iter().sum::<f64>() / n.max(1) as f64;
    let product = |lag: usize| -> f64 {
        (errors[..n - lag].iter().zip(&errors[lag..]))
            .map(|(a, b)| (a - mean) * (b - mean))
            .sum()
    };
    let variance = product(0);
    if n < 2 || variance <= 0.0 {
        return n as f64;
    }
    let sum = correlation_sum(n / 2, |lag| product(lag) / variance);
    n as f64 / (1.0 + 2.0 * sum)
}
