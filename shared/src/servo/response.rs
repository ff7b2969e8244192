//! How a step was answered.

use serde::{Deserialize, Serialize};

/// Overshoot and settling of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Response {
    /// Largest excess over the target, a part of the step.
    pub overshoot: f32,
    /// Periods until the angle stays within the band.
    pub settling: u32,
    /// Where it was in the end, counts from the target.
    pub left: f32,
}

/// A step under way.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    target: f32,
    band: f32,
    periods: u32,
    settled: u32,
    most: f32,
    left: f32,
}

/// Part of a step that settling allows …
const BAND: f32 = 0.05;
/// … and at least so many counts.
const LEAST_BAND: f32 = 2.0;

impl Step {
    /// Nothing.
    pub const NONE: Self = Step {
        target: 0.0,
        band: 0.0,
        periods: 0,
        settled: 0,
        most: 0.0,
        left: 0.0,
    };

    /// Begins a step of so many counts forward.
    pub fn begin(&mut self, target: f32) {
        *self = Step {
            target,
            band: (BAND * target).max(LEAST_BAND),
            ..Step::NONE
        };
    }

    /// Takes the reading of a period.
    pub fn see(&mut self, counts: i32) {
        self.periods += 1;
        self.left = counts as f32 - self.target;
        self.most = self.most.max(self.left);
        if self.left.abs() > self.band {
            self.settled = self.periods;
        }
    }

    /// How it was answered so far.
    pub fn response(&self) -> Response {
        Response {
            overshoot: self.most / self.target,
            settling: self.settled,
            left: self.left,
        }
    }
}
