//! What a fit found.

use super::covariance::Covariance;
use super::{MOST, Point, Space};
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Why a fit ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Stop {
    /// Search and polish are done.
    Converged,
    /// No candidate could be built: the motor is beyond the number format.
    NoModel,
}

/// A value with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Estimate {
    /// In the device's own measure, see [`Unknown`](super::Unknown).
    pub value: f32,
    /// From the curvature of the cost and from what the model leaves; infinite where there is no model.
    pub std: f32,
}

/// What a fit found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Outcome {
    /// One for each unknown: gain, first-order coefficient and electrical time constant, then friction and load if asked for.
    pub estimates: Vec<Estimate, MOST>,
    /// Mean squared error, counts².
    pub mean_square: f32,
    /// Models that were run.
    pub evaluations: u32,
    /// Why it ended.
    pub stop: Stop,
}

impl Outcome {
    pub(super) fn new(
        space: &Space,
        best: Point,
        least: f32,
        covariance: &Covariance,
        evaluations: u32,
        stop: Stop,
    ) -> Self {
        let mut estimates = Vec::new();
        for k in 0..space.dim() {
            // There is room for all.
            let _ = estimates.push(Estimate {
                value: space.value(k, &best),
                std: covariance.std(&space.gradient(k, &best)),
            });
        }
        Outcome {
            estimates,
            mean_square: least,
            evaluations,
            stop,
        }
    }
}
