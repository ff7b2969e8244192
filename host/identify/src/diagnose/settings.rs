//! The numbers that decide outside of the stages that have settings of their own.

use shared::encoder::FLOOR_RMS_COUNTS;

// built_up

/// A sum of squares beyond this, in parts of what the encoder leaves, is worth another start.
pub const LOST: f64 = 1.2;

// conclude

/// A whole run further from the readings than so many times the floor of its windows says that the floor was none: a sensor that
/// holds its value looks like noise from which no window can stray.
pub const STRAYED: f64 = 10.0;

// hypotheses

/// A set that is less probable than this is not listed.
pub const LEAST: f64 = 0.01;
/// Probability that the catalogue holds the truth where a model reaches the encoder's floor.
pub const AT_FLOOR: f64 = 0.98;
/// The same, at most, where none does.
pub const ABOVE_FLOOR: f64 = 0.9;
/// Part of the fitted recording's samples whose errors are independent at the encoder's floor: counts dwell in their cells. There a parameter
/// has the price of the Bayesian information criterion (Schwarz, "Estimating the dimension of a model", 1978).
pub const INDEPENDENT: f64 = 0.1;

// linear

/// A constant that lowers the linear motor's error to this part shows that the motor is another.
pub const OTHER_MOTOR: f64 = 0.2;

// models/errors

/// Errors below this are the encoder's own, counts RMS: its floor of 0.2887 with room for a recording
/// whose readings dwell in one part of their cells.
pub const NOISE_COUNTS: f64 = 0.33;
/// Room above the floor, for a recording whose readings dwell in one part of their cells.
pub const ROOM: f64 = NOISE_COUNTS / FLOOR_RMS_COUNTS;

// models/fitted_model

/// A chaotic run that was followed over such a part of the recording proves the model.
pub const PROOF: f64 = 0.5;

// negligible

/// Part of its typical size below which an effect is negligible: of a voltage or a torque, about 1e-4 of the supply.
pub const PART_OF_TYPICAL: f64 = 1.0 / 300.0;
/// Part of a count below which an angle is.
pub const PART_OF_COUNT: f64 = 0.1;

// recordings/holdout

/// Part of the recording that is fitted where its end is held out.
pub const FITTED_PART: f64 = 0.75;
/// How long a rest must have lasted, s.
pub const REST_S: f64 = 0.05;
/// Least length of the part that is held out, s.
pub const LEAST_S: f64 = 0.25;

// rivals

/// More models than this that explain a recording alike, and none of them is named.
pub const MOST_EQUIVALENT: usize = 4;

// settle

/// Evaluations for the end of a fit that stands near its minimum.
pub const BUDGET: usize = 400;

// models/observer_errors

/// How long an error may be remembered, s, the longest first.
pub const MEMORIES_S: [f64; 3] = [0.1, 0.03, 0.01];
