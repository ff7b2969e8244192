//! Covariance of the estimate: the curvature, and the sandwich over blocks of time.
//!
//! Both can be far too small: the sandwich where all that is learnt lies in one block, as of a single step; the curvature
//! where the noise is not white. So the larger of the two counts.

use super::objective::{Evaluated, Objective};
use super::parameters::{Coordinate, Scale};
use super::slopes::{Differences, slopes};
use nalgebra::{DMatrix, DVector};

/// Length of a block, s.
const BLOCK_S: f64 = 0.5;
/// Part of the largest eigenvalue below which the data hold no direction, of the matrix scaled to a diagonal of one.
const FLAT: f64 = 1e-13;

/// Standard errors and correlations of the coordinates.
#[derive(Clone, Debug)]
pub(super) struct Errors {
    /// Covariance by the curvature, SI.
    pub(super) curvature: DMatrix<f64>,
    /// Covariance by the sandwich, SI.
    pub(super) sandwich: DMatrix<f64>,
    /// Coordinates that have no error: a noise at its lower bound, or one that the data do not hold.
    pub(super) unknown: Vec<bool>,
}

impl Errors {
    /// Standard error of a sum with these weights: the larger of the two.
    pub(super) fn of(&self, weights: &DVector<f64>) -> f64 {
        let variance = |c: &DMatrix<f64>| (weights.transpose() * c * weights)[(0, 0)].max(0.0);
        variance(&self.curvature)
            .max(variance(&self.sandwich))
            .sqrt()
    }
}

/// At the estimate.
pub(super) fn errors(
    objective: &Objective<'_>,
    here: &Evaluated,
    coordinates: &[(Coordinate, Scale)],
) -> Option<Errors> {
    let slopes = slopes(objective, here, coordinates, Differences::WIDE)?;
    let count = coordinates.len();
    let mut unknown: Vec<bool> = (coordinates.iter())
        .map(|(c, scale)| c.is_noise() && scale.at_least(*c, &here.parameters))
        .collect();
    let size: Vec<f64> = (0..count)
        .map(|i| {
            let curvature = slopes.information[(i, i)];
            if unknown[i] || curvature <= 0.0 {
                0.0
            } else {
                curvature.sqrt().recip()
            }
        })
        .collect();
    let scaled =
        |m: &DMatrix<f64>| DMatrix::from_fn(count, count, |i, j| m[(i, j)] * size[i] * size[j]);
    let eigen = scaled(&slopes.information).symmetric_eigen();
    let mut inverse = DMatrix::zeros(count, count);
    let largest = eigen.eigenvalues.max();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if *value > FLAT * largest {
            inverse += vector * vector.transpose() / *value;
        } else {
            for (i, share) in vector.iter().enumerate() {
                unknown[i] |= share * share > 1e-3;
            }
        }
    }
    let middle = scaled(&blocks(objective, &slopes.scores));
    let natural: Vec<f64> = (coordinates.iter().zip(&size))
        .map(|((c, scale), size)| size * scale.slope(*c, &here.parameters))
        .collect();
    let in_si = |m: &DMatrix<f64>| {
        DMatrix::from_fn(count, count, |i, j| m[(i, j)] * natural[i] * natural[j])
    };
    Some(Errors {
        curvature: in_si(&inverse),
        sandwich: in_si(&(&inverse * middle * &inverse)),
        unknown,
    })
}

/// Sum over blocks of the squares of their scores.
fn blocks(objective: &Objective<'_>, scores: &[Vec<f64>]) -> DMatrix<f64> {
    let count = scores.len();
    let mut sum = DMatrix::zeros(count, count);
    let mut block = DVector::zeros(count);
    let mut current = None;
    for (k, (recording, time)) in objective.times().enumerate() {
        let this = (recording, (time / BLOCK_S).floor() as i64);
        if current.is_some_and(|current| current != this) {
            sum += &block * block.transpose();
            block.fill(0.0);
        }
        current = Some(this);
        for (i, score) in scores.iter().enumerate() {
            block[i] += score[k];
        }
    }
    sum + &block * block.transpose()
}
