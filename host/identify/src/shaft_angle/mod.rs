//! Recordings that begin at different angles of the shaft. An incremental encoder counts from where it was switched on, so a torque that repeats
//! with the angle stands elsewhere in each log, and no model with it holds for two of them. What the logs have in common shows by how much: the
//! same waves a revolution, of the same amplitudes, shifted.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `found` | by how much a recording is shifted |
//! | `align` | recordings in terms of the first one's angle |

mod align;
mod found;
mod settings;
#[cfg(test)]
mod tests;

pub use align::{align_shaft_angles, turns};
