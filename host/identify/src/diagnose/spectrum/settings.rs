//! The numbers of this stage that decide.

// spectrum

/// Most orders that are listed.
pub const MOST: usize = 12;
/// A further order must explain this part of what the others leave.
pub const WORTH: f64 = 0.1;

// orders

/// Fewest samples that must show a line for it to count.
pub const FEWEST: f64 = 200.0;
/// Fewest waves that the shaft must have turned through: what it met once or twice need not be a thing that repeats.
pub const WAVES: f64 = 3.0;
/// Filter times of the equation's residual, sample intervals: the short one where the shaft turns through a wave in a few samples, which the long one
/// wears away (order 7 at 200 Hz: 63 % of the residual, and nothing), the long one where the counter's steps hide the wave.
pub const FILTERS_SAMPLES: [f64; 2] = [1.0, 3.0];

// waves

/// Highest order that is looked for.
pub const HIGHEST: usize = 128;
/// Orders side by side.
pub const LANES: usize = 8;
/// Such rows of orders.
pub const ROWS: usize = HIGHEST / LANES;
/// Below this many radians within an interval, the mean of a wave is that of its ends.
pub const SLOW: f64 = 1e-2;
