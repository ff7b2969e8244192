//! Fitting a model to a recording: start from regression, search, and say what was learnt.
//!
//! | file | holds |
//! |---|---|
//! | `options`, `bound` | what to fit, and how; a range that the user set |
//! | `filter` | state variable filters of measured signals |
//! | `regression` | a first guess at the model, without a simulation |
//! | `start` | the problem that recording and options state, started at the best guess |
//! | `search` | its search by one method |
//! | `integration` | whether the model's steps are short enough for the standard errors |
//! | `interval` | the likelihood of the cells that were read, with the noise before the counter |
//! | `forms` | other forms than the textbook's, where those leave something to explain |
//! | `correlation_time` | for how long an error is correlated with itself |
//! | `sensitivity` | sums over the Jacobian of the residuals |
//! | `uncertainty` | the covariance of the unknowns |
//! | `joint` | the unknowns with their covariance, for those who draw from it |
//! | `armature_current` | what a measured current says of inertia and viscous friction |
//! | `physical` | the six physical parameters from data and known facts |
//! | `profile` | how much worse a fit becomes as one parameter is held elsewhere |
//! | `systematic` | what parameters change by if the recording is not what it says |
//! | `plausibility` | whether the machine can be one |
//! | `margins` | stability margins of the position loop |
//! | `scores` | errors over windows and of the equation, where the open loop drifts |
//! | `validate` | the error on another recording |
//! | `wave` | amplitude and phase of a wave of two unknowns |
//! | `remarks` | what a user should know before believing a fit |
//! | `own_parameters` | several recordings with parameters of their own beside the common ones |
//! | `recordings` | the error on each of several recordings, and how far their parameters spread |
//! | `parameter` | its parameters with their standard errors, in the units that a user can use |
//! | `report` | the fitted model with all of these |
//! | `error_ladder` | the error as effects are added one by one |

mod armature_current;
mod bound;
pub mod bridge;
mod correlation_time;
mod error_ladder;
pub(crate) mod filter;
pub(crate) mod forms;
pub(crate) mod integration;
pub(crate) mod interval;
mod joint;
pub mod margins;
mod options;
pub(crate) mod own_parameters;
mod parameter;
pub mod physical;
mod plausibility;
pub(crate) mod profile;
pub(crate) mod recordings;
pub mod regression;
mod remarks;
pub mod report;

pub mod scores;
mod search;
mod sensitivity;
mod start;
pub(crate) mod systematic;
pub mod uncertainty;
mod validate;
mod wave;

pub use bound::Bound;
pub use correlation_time::correlation_sum;
pub use error_ladder::error_ladder;
pub use interval::{LEAST_NOISE, ReadingNoise};
pub use joint::Joint;
pub use options::{COSTS, Options, cost_by_name, cost_name, effects_by_name};
pub use own_parameters::OwnParameter;
pub use parameter::{Parameter, Usual};
pub use plausibility::{Contradiction, contradictions};
pub use profile::{Profile, RISE_95};
pub use recordings::RecordingError;
pub use remarks::EXPLAINED_COUNTS;
pub use report::{Fit, LadderEntry};
pub use search::search;
pub use start::{SPEED_HALF_WIDTH, base_for, is_reversed, problem};
pub use systematic::{Cause, Systematic};
pub use validate::{START_OFFSETS, departure, validate, validate_roughly, validation_errors};
