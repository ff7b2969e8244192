//! Errors on both recordings, and what a model is worth by them.

pub use crate::diagnose::settings::{NOISE_COUNTS, ROOM};

/// RMS errors on both recordings, counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// On the fitted recording.
    pub fitted: f64,
    /// On the held-out recording.
    pub held_out: f64,
    /// What the reading's own noise makes of a right model.
    pub floor: f64,
}

impl Errors {
    /// Whether both are the encoder's own.
    pub fn at_floor(&self) -> bool {
        self.fitted_at_floor() && self.held_out < self.floor * ROOM
    }

    /// Whether that on the fitted recording is the encoder's own.
    pub fn fitted_at_floor(&self) -> bool {
        self.fitted < self.floor * ROOM
    }

    /// Mean square error on the held-out recording beyond the reading's own.
    pub fn excess(&self) -> f64 {
        self.beyond_floor(self.held_out)
    }

    /// The same on the fitted recording.
    pub fn fitted_excess(&self) -> f64 {
        self.beyond_floor(self.fitted)
    }

    fn beyond_floor(&self, rms: f64) -> f64 {
        (rms.powi(2) - self.floor.powi(2)).max(0.0)
    }

    /// ln(fitted · held-out), neither counted below the noise: what candidates are ranked by.
    pub fn score(&self) -> f64 {
        let floored = |rms: f64| rms.max(self.floor);
        libm::log(floored(self.fitted) * floored(self.held_out))
    }
}
