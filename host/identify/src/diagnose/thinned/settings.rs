//! The numbers that decide how many readings a search needs. On the recordings of a kit (2 kHz, time constant 12 ms) every fourth reading led to
//! errors within some percent of those from all, in a fifth of the time.

/// Fewest readings that are left of a recording.
pub const FEWEST_READINGS: usize = 5000;
/// Fewest in a time constant of the motor, and in a window.
pub const IN_TIME_CONSTANT: f64 = 6.0;
pub const IN_WINDOW: f64 = 50.0;
/// Most of a revolution between two of them: torque that repeats with the angle must still be seen.
pub const MOST_TURNS: f64 = 0.1;
/// Readings of a long bench along which proposals are searched for: twenty seconds at 1 kHz. Twenty minutes took more than two to propose anything.
pub const MOST_READINGS: usize = 20_000;
/// Proposals of a long bench that are scored on all readings.
pub const MOST_ON_ALL: usize = 6;
