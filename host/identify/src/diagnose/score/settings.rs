//! The numbers of the score. Measured with the prototype behind the method (63 sets of effects on 33 cases of an independent plant,
//! and real recordings with repeats).

/// A reading is one at rest if the angle stays within a count for so long before and after it, s.
pub const REST_S: f64 = 0.05;
/// Readings that a whole rest weighs at most: a motor at rest says the same thing a thousand times.
pub const REST_READINGS: f64 = 3.0;
/// Fewest samples between two corrections.
pub const LEAST_SAMPLES: f64 = 5.0;
/// Longest time between two corrections, s. Between the two it is the motor's time constant: at shorter ones friction that
/// holds is preferred to what predicts.
pub const LONGEST_S: f64 = 0.2;
/// Time between two corrections where no back-EMF damps the motor, so that it has no time constant of that kind, s: short enough for torques
/// that repeat some ten times a revolution of a slow motor.
pub const UNDAMPED_INTERVAL_S: f64 = 0.05;
/// Standard deviation of the prior on the logarithms of gain and time constant about what regression says. It is weak: it
/// keeps away the motor that ignores its voltage.
pub const PRIOR_SD: f64 = 1.0;
/// Model evaluations that an estimate of a recording's noise may take.
pub const NOISE_RUNS: usize = 60;
/// Most lags over which innovations may be correlated.
pub const MOST_LAGS: usize = 50;
/// Fewest readings in motion from which it can be told whether anything is left in the innovations; from 350 the prototype read nonsense.
pub const FEWEST_READINGS: usize = 1000;
/// Folds of the cross-validation.
pub const FOLDS: usize = 8;
/// Blocks of time that the folds take turns in.
pub const BLOCKS: usize = 24;
/// The ridge, of standardised inputs.
pub const RIDGE: f64 = 10.0;
/// Most orders of the angle among the inputs.
pub const ORDERS: u32 = 8;
/// Part of the innovations' variance that may be foretold of a model that lacks nothing: the right sets of the prototype had 3 to 8 %,
/// those that lacked an effect 10 to 66 %.
pub const FORETOLD: f64 = 0.05;
/// Step of the differences from which a score's curvature is taken, parts of a search range.
pub const STEP: f64 = 1e-4;
/// Precision of a parameter of which nothing is known but its search range: one over the variance of a uniform distribution, range = 1.
pub const RANGE_PRECISION: f64 = 12.0;
/// A standard error of so much of the search range, where nothing at all is 0.29, tells nothing.
pub const KNOWN_PART: f64 = 0.2;

// foretold

/// Part of the fastest speed below which a motor has no direction, roughly.
pub const SLOW: f64 = 0.02;
/// Times since a reversal over which something may decay, s.
pub const SINCE_REVERSAL_S: [f64; 3] = [0.03, 0.15, 0.6];
/// Parts of the fastest speed over which friction may fall.
pub const FALLING: [f64; 2] = [0.03, 0.1];

// gains

/// Time constant of a motor that nothing damps, s.
pub const UNDAMPED_S: f64 = 1e4;
/// Shortest time constant, s.
pub const SHORTEST_S: f64 = 1e-6;
/// Part of the time constant below which the closed form of the angle's variance loses its digits.
pub const SHORT: f64 = 1e-2;

// likelihood

/// Fewest innovations that tell how they are correlated.
pub const FEWEST: usize = 20;

// readings

/// A reading that counts may differ by so many standard deviations of its noise and still be one at rest.
pub const STILL: f64 = 4.0;
/// A reading this part of a sample too early is the one that was meant.
pub const TIME_ROUNDING: f64 = 1e-3;

// repeatability

/// Steps of the integral over a window.
pub const STEPS: usize = 50;

// noise

pub const MIDDLE: [f64; 2] = [0.5, 0.0];
/// Parts of the torque's range from which a search starts.
pub const STARTS: [f64; 4] = [0.15, 0.4, 0.6, 0.8];
