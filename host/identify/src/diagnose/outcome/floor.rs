//! What stands below a model's error.

use crate::diagnose::score::Foretold;

/// What a right model would still miss the fitted recordings by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Floor {
    /// What it is.
    pub kind: FloorKind,
    /// RMS error, counts.
    pub counts: f64,
    /// Length of the windows over which it holds, s; whole runs where `None`.
    pub window_s: Option<f64>,
    /// What the observer's own prediction foretells of what it did not expect; nothing where too little moves.
    pub foretold: Option<Foretold>,
}

/// What a floor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloorKind {
    /// The encoder's own error.
    Encoder,
    /// The motor's own repeatability: nothing is left that its command and its motion foretell.
    Repeatability,
    /// Not known: the figure is what the motor's repeatability would be if nothing were missing.
    Unknown,
}

impl FloorKind {
    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            FloorKind::Encoder => "encoder",
            FloorKind::Repeatability => "repeatability",
            FloorKind::Unknown => "unknown",
        }
    }
}
