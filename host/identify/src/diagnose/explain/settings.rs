//! The numbers of this stage that decide.

use crate::diagnose::models::NOISE_COUNTS;

// evidence

/// A mean counts as different from zero from so many standard errors on.
pub const SURE: f64 = 5.0;
/// A level that changes by less than this part of itself from slow to fast does not grow.
pub const LEVEL: f64 = 0.3;
/// Sizes that differ by more than this part are different.
pub const DIFFERENT: f64 = 0.1;
/// A line at one order counts from this share of the missing volts on.
pub const LINE: f64 = 0.2;
/// Phases of one line in the two directions that are nearer than this belong together, degrees.
pub const IN_PHASE: f64 = 40.0;

// pair

/// Both recordings count as explained by models of their own up to this error, counts RMS.
pub const EXPLAINED: f64 = 3.0 * NOISE_COUNTS;
/// A model of the one must be so many times worse on the other to be called a stranger to it.
pub const STRANGE: f64 = 5.0;
/// Parameters differ from so many standard errors on.
pub const DIFFERENCE_SURE: f64 = 6.0;
/// And by at least this part of their value.
pub const DIFFERENT_MOTORS: f64 = 0.02;
/// Where no model explains both: constants of the linear motors that differ by this factor are beyond what a
/// single effect does to them.
pub const BEYOND: f64 = 2.0;
/// Ratios nearer to each other than this are those of one motor in two units.
pub const SAME_MOTOR: f64 = 0.05;
/// A jump of the error by at least so many counts within a sample that stays is the counter's.
pub const JUMP_COUNTS: f64 = 2.0;
/// In medians of the usual change from sample to sample.
pub const JUMP_TIMES: f64 = 6.0;
/// More than one jump in so many samples is no counter's: the model is wrong.
pub const SELDOM: usize = 100;
/// An impact in a gear follows a reversal of the shaft within this time, s.
pub const REVERSAL_S: f64 = 0.1;
