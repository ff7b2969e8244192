//! An effect that a caller brings along.

use super::effects::{At, Effect, Sliding};
use std::fmt;
use std::sync::Arc;

/// An effect that is none of the catalogue: its equation is the caller's.
#[derive(Clone)]
pub struct Stated(pub Arc<dyn Effect>);

impl fmt::Debug for Stated {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("stated effect")
    }
}

impl Effect for Stated {
    fn volts(&self, volts: f64, at: &At) -> f64 {
        self.0.volts(volts, at)
    }

    fn torque(&self, at: &At) -> f64 {
        self.0.torque(at)
    }

    fn friction(&self, sliding: &Sliding) -> f64 {
        self.0.friction(sliding)
    }

    fn inertia(&self, angle: f64) -> [f64; 2] {
        self.0.inertia(angle)
    }

    fn memory(&self) -> Option<f64> {
        self.0.memory()
    }

    fn memory_rate(&self, at: &At) -> f64 {
        self.0.memory_rate(at)
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        self.0.stiffness_per_s(at)
    }

    fn sensed_angle(&self, angle: f64) -> f64 {
        self.0.sensed_angle(angle)
    }
}
