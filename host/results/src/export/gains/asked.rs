//! What a user asks of the controllers.

use super::design::Method;
use clap::ValueEnum;

/// What a user asks of the controllers; everything has a usual value.
#[derive(Clone, Copy, Debug, Default)]
pub struct Asked {
    /// Crossover of the current loop, Hz.
    pub current_hz: Option<f64>,
    /// Crossover of the speed loop, Hz.
    pub speed_hz: Option<f64>,
    /// How the speed loop's zero is placed.
    pub method: Option<Method>,
    /// Which loops.
    pub loops: Option<Loops>,
}

/// Which loops are closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Loops {
    /// A current loop, and a speed loop around it
    Cascade,
    /// One speed loop that gives volts
    Voltage,
}
