//! Readings as small numbers: what is left of them above a line of its own for each block, in single precision, with
//! what that loses.
//!
//! A reading has seven digits before the point on a long recording and single precision has seven in all; above the line that
//! the shaft went along it has two or three.

use super::Block;
use crate::problem::held::STRIDE;

/// Rounding of a number in single precision, as a part of it.
pub(super) const ROUNDING: f64 = 0.5 * f32::EPSILON as f64;

/// The readings of a block.
pub(super) struct Rebased {
    /// The line at the first sample, counts.
    pub(super) level: f64,
    /// How it rises with each sample, counts.
    pub(super) slope: f64,
    /// What is left of the readings; zeros behind the last one.
    pub(super) left: Vec<[f32; STRIDE]>,
    /// Largest magnitude of it, counts.
    pub(super) most: f64,
    /// Largest magnitude that a reading or the line has, counts.
    pub(super) farthest: f64,
    /// Sum of what single precision has changed in it, counts.
    pub(super) lost: f64,
}

impl Rebased {
    /// Those of a block.
    pub(super) fn new(block: &Block, counts: &[f64]) -> Self {
        let readings = &counts[block.range.clone()];
        let (first, last) = (
            readings.first().copied().unwrap_or(0.0),
            readings.last().copied().unwrap_or(0.0),
        );
        let slope = (last - first) / (readings.len().max(2) - 1) as f64;
        let mut rebased = Rebased {
            level: first,
            slope,
            left: vec![[0.0; STRIDE]; readings.len().div_ceil(STRIDE)],
            most: 0.0,
            farthest: first.abs().max(last.abs()),
            lost: 0.0,
        };
        for (k, &reading) in readings.iter().enumerate() {
            let left = reading - (first + slope * k as f64);
            let single = left as f32;
            rebased.left[k / STRIDE][k % STRIDE] = single;
            rebased.most = rebased.most.max(left.abs());
            rebased.farthest = rebased.farthest.max(reading.abs());
            rebased.lost += (f64::from(single) - left).abs();
        }
        rebased
    }
}
