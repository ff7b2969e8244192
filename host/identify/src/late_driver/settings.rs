//! The numbers that decide whether a driver woke late. Measured on 115 recordings of the bench with one effect each, and on those of a kit whose
//! driver woke 45 to 135 ms late four times.

/// Length of the windows in which the first moments are held against the rest, s.
pub const WINDOW_S: f64 = 0.5;
/// Fewest samples of rest before the first motion.
pub const RESTED: usize = 5;
/// The error of the first window is so many times that of any other in which the speed changes as much. It was at most 1.07 in 115
/// recordings of the bench with one effect each, and 2.1 to 5.2 where a driver woke 45 to 135 ms late.
pub const OUTLIER: f64 = 1.5;
/// It falls to this part once the bridge is open until the motion begins. A slow ramp fell to 0.79, drivers that woke late to 0.08 to 0.29.
pub const CURED: f64 = 0.5;
/// Part of the first window's change of speed from which on another is compared with it.
pub const AS_LIVELY: f64 = 0.5;
/// Fewest windows to compare with: what is seen once may be a delay.
pub const FEWEST: usize = 2;
