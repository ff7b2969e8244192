//! The few things that a board must do. Everything above this trait runs on any board, and on none.

use crate::phase::Fault;

/// An H bridge, a quadrature encoder and a control period.
///
/// A board keeps its own electrical limits (shoot-through, dead time, over-current); it does not know the motor.
pub trait Board {
    /// Applies `duty` to the winding until the next call, in Q15 of the supply voltage: `duty / 32768` of it, from
    /// `-32768` (full reverse) to `32767` (one step below full forward). Zero puts zero volts across the winding, which
    /// brakes the motor; for no drive at all see [`coast`](Self::coast).
    fn drive(&mut self, duty: i16);

    /// Opens the bridge: no current path, the motor coasts. The state after reset and after every fault, so it must
    /// work at any time, any number of times, and cannot fail.
    fn coast(&mut self);

    /// The encoder's position in counts, floor-quantised and cumulative, from wherever it started. It wraps around at
    /// the ends of `i32`: only differences taken with `wrapping_sub` mean anything. A board whose timer is 16 bits wide
    /// extends it here.
    fn count(&mut self) -> i32;

    /// Waits for the end of the control period.
    ///
    /// # Errors
    ///
    /// [`Fault::Overrun`] if that end had already passed, so that the last duty lasted longer than a period;
    /// [`Fault::Bridge`] if the bridge's own protection switched it off.
    fn tick(&mut self) -> Result<(), Fault>;
}
