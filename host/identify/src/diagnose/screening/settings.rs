//! The numbers of this stage that decide.

// screening

/// Where the search for a share of friction starts.
pub const FRICTION_SHARE: f64 = 0.5;
/// Most orders of a cogging torque in a model.
pub const MOST_ORDERS: usize = 5;
/// Starts that are left after a glance at all of them.
pub const GLANCED: usize = 2;
/// An effect that the series-parallel model does not follow, and that leaves more than this part of the error from its
/// first start, gets no other.
pub const PROMISING: f64 = 0.9;
/// The textbook's form of an effect, and its relative.
pub const FORMS: [f64; 2] = [0.0, 1.0];

// starts

/// Lines of the angle's spectrum that are tried.
pub const LINES: usize = 3;
/// Part of the typical amplitude to start from.
pub const AMPLITUDE: f64 = 0.5;
