//! A driver that wakes after the log has begun: its first commands are logged and move nothing. No physics of the motor does that, and the
//! error of these moments hides all others; they are cut off.
//!
//! It shows where a motor that rests at first and is then seen to move is started too early by a linear motor with Coulomb friction that
//! was regressed on the rest of the recording: by far more than that model misses any other start or reversal, and no longer once its
//! bridge is open until the motion begins. A delay of the bus and friction that holds are seen at other starts, too.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `found` | when a driver woke, and the recording without the moments before |

mod found;
mod settings;
#[cfg(test)]
mod tests;

pub use found::{LateDriver, cut_late_drivers};
