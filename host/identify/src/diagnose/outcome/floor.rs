//! What stands below a model's error.

use crate::diagnose::score::Foretold;
use crate::repeats::LackOfFit;

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
    /// What repeats of a command tell, where there are any: then the floor is theirs.
    pub repeats: Option<Repeated>,
}

/// What repeats of a command tell of the first and of the last model of a diagnosis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeated {
    /// Of the linear motor.
    pub base: LackOfFit,
    /// Of the model with all effects.
    pub last: LackOfFit,
}

impl Floor {
    /// Whether the last model reaches it.
    pub fn is_reached(&self) -> bool {
        match (self.kind, &self.repeats) {
            (FloorKind::Repeatability, Some(repeats)) => repeats.last.is_repeatability(),
            (FloorKind::Encoder | FloorKind::Repeatability, _) => true,
            (FloorKind::Unknown, _) => false,
        }
    }

    /// What tells it, as JSON names it; `None` where it is the encoder's.
    pub fn told_by(&self) -> Option<&'static str> {
        match self.kind {
            FloorKind::Encoder => None,
            _ if self.repeats.is_some() => Some("repeats"),
            _ => Some("innovations"),
        }
    }
}

/// What a floor is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FloorKind {
    /// The encoder's own error.
    Encoder,
    /// The motor's own repeatability: what its repeats differ by; without repeats, where nothing is left that its command and its motion
    /// foretell.
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
