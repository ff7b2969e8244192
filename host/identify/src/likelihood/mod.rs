//! A likelihood with process noise: the second fit of a recording of real motion, beside the free run.
//!
//! A free run takes all that is not in the model for an error of the reading, so that a torque which the model lacks drifts
//! away with it and bends the parameters. Here the motor is a stochastic differential equation,
//!
//! ```text
//! a·dω/dt = u(t − T) + offset − gravity(θ) − b·ω − c·sign(ω) + s·(white noise)      V
//! dθ/dt = ω,     reading = θ + e,     var e = lsb²/12 + r²                          rad
//! ```
//!
//! and an extended Kalman filter predicts each reading from those before. What is maximised is the likelihood of its
//! innovations; the intensities `s` (V·√s) and `r` (rad) are estimated with the physics.
//!
//! What it is for: inertia, delay and standard errors where the command has edges, and ranking of terms by BIC. It is no
//! better than a free run in windows at what that minimises, the error of a free run.
//!
//! When it fails: without edges it sees `delay + a/b` only. A disturbance that wanders slowly is not white, and the
//! intervals are then too narrow. Near zero speed in closed loop the linearised filter is wrong in Coulomb friction. The
//! electrical time constant is neglected and comes out as delay.
//!
//! Sources: N. R. Kristensen, H. Madsen, S. B. Jørgensen, *Automatica* 40(2), 225, 2004 (grey-box models as stochastic
//! differential equations, CTSM); L. Ljung, *System Identification*, 2nd ed., 1999, §7.4 (innovations form, likelihood),
//! §9 (covariance); R. E. Kalman, *J. Basic Eng.* 82, 35, 1960; P. J. Huber, *Robust Statistics*, 1981.
//!
//! | file | holds |
//! |---|---|
//! | `observed` | a recording in SI, with the readings that are used |
//! | `input` | the mean of the delayed command over each step |
//! | `terms` | which terms a model has |
//! | `parameters` | their values, and the coordinates in which they are searched |
//! | `decay` | what an interval of a length does to the speed, and the noise that it adds |
//! | `step` | one step with the stop located in it, and its Jacobian |
//! | `kalman` | the filter: innovations and their variances |
//! | `huber` | the loss of an innovation that is far out |
//! | `objective` | minus the logarithm of the likelihood |
//! | `slopes` | its gradient and Fisher information |
//! | `scoring` | its minimum, by scoring with Levenberg's damping |
//! | `start` | where that starts: regression, and a grid of delays |
//! | `errors` | covariance: curvature, and the sandwich over blocks |
//! | `whiteness` | whether the innovations are white |
//! | `maximum` | the fit of one or several recordings |
//! | `rank` | sets of terms by their BIC |
//! | `section` | what `fit` says of it beside its free run |

mod decay;
mod errors;
mod huber;
mod input;
mod kalman;
mod maximum;
mod objective;
mod observed;
mod parameters;
mod rank;
mod scoring;
mod section;
mod slopes;
mod start;
mod step;
mod terms;
#[cfg(test)]
mod tests;
mod whiteness;

pub use huber::{HUBER, huber};
pub use maximum::{Maximum, Settings, fit, fit_from};
pub use observed::Observed;
pub use parameters::{Coordinate, Parameters};
pub use rank::{Ranked, rank};
pub use section::{Check, Disagreement, Likelihood, Value, section};
pub use terms::{Delays, Terms};
pub use whiteness::Whiteness;
