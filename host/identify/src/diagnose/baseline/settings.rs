//! The numbers of this stage that decide.

// baseline

/// A model may predict worse than the baseline by this part before it is given up: less is chance.
pub const AS_GOOD: f64 = 0.01;
/// The same for a model that only an observer keeps to the readings: where a free run slips over a detent is chance, and so
/// are its errors, which then prefer any friction.
pub const CHAOTIC: f64 = 0.5;
/// Where the motor never reverses, the part of the score's gain over the linear motor that lies beyond the baseline's terms in a set that
/// is sure: a real torque of cogging gained 0.29, a once-per-revolution torque that differs from run to run 0.01.
pub const ONE_WAY_GAIN: f64 = 0.1;
/// Part of a diagnosis' budget that the comparison may take besides.
pub const PART: f64 = 0.25;

// models

/// Where the fits start: Coulomb friction in parts of the supply, and delays in s.
pub const FRICTION: f64 = 0.05;
pub const DELAYS_S: [f64; 3] = [0.0, 0.004, 0.04];
