//! Errors that are soon forgotten: those of a run that an observer holds to the readings.

use super::errors::Errors;
pub use crate::diagnose::settings::MEMORIES_S;

/// Errors that are soon forgotten.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverErrors {
    /// On both recordings.
    pub errors: Errors,
    /// How long an error is remembered, s.
    pub memory_s: f64,
}

impl ObserverErrors {
    /// Whether the model is held as loosely as any.
    pub fn is_loose(&self) -> bool {
        self.memory_s == MEMORIES_S[0]
    }
}
