//! What a board that is put together of parts measures beside its encoder.
//!
//! `embedded-hal` 1.0 has no ADC: a board reads its HAL's in its own type.

/// Sensors of current, supply and temperature; each may be missing.
pub trait Sensors {
    /// True if [`current_ma`](Self::current_ma) measures: then its limits hold by what flows, and not by what a resistance lets be assumed.
    const CURRENT: bool = false;
    /// See [`Board::CURRENT_LIMIT_MA`](super::Board::CURRENT_LIMIT_MA).
    const CURRENT_LIMIT_MA: u32 = 0;
    /// See [`Board::CURRENT_RESOLUTION_MA`](super::Board::CURRENT_RESOLUTION_MA).
    const CURRENT_RESOLUTION_MA: u16 = 1;

    /// Armature current, mA, positive as it flows when a positive duty drives a motor at rest. It is asked once a control period, when the
    /// carrier has turned: a shunt below a leg conducts then. Where the ADC fills a ring by itself, the mean over a wave of the carrier has no
    /// ripple.
    fn current_ma(&mut self) -> i32 {
        0
    }

    /// Supply voltage of the bridge, mV.
    fn supply_mv(&mut self) -> Option<u16> {
        None
    }

    /// True if the bridge is too hot. Asked while it drives.
    fn is_hot(&mut self) -> bool {
        false
    }
}

/// A board without sensors.
#[derive(Debug, Default)]
pub struct NoSensors;

impl Sensors for NoSensors {}
