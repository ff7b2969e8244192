//! A drive that closes a position loop: its command is a target angle, and the volts behind it follow from the target, the
//! reading, and the loop's gains.
//!
//! The loop acts on the *measured* angle, which the recording has. So its output is no unknown: a recording of targets is
//! turned into one of volts where it is read, and all that stands behind works as for any voltage. This is direct
//! identification in closed loop (L. Ljung, "System Identification", 2nd ed., 13.4).
//!
//! | file | holds |
//! |---|---|
//! | `settings` | what is said of a loop, and a loop with all its numbers |
//! | `output` | the volts of a loop over the intervals of a recording |
//! | `motion` | how well volts explain the measured motion |
//! | `gain` | an unknown gain, where the loop's output reaches its limit |

mod gain;
mod motion;
mod output;
mod settings;
#[cfg(test)]
mod tests;

pub use gain::{GainEstimate, GainUnknown};
pub use output::Follower;
pub use settings::{GainOrigin, LoopSettings, PositionLoop};
