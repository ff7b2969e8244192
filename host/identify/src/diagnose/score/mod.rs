//! One number for every model of a set of recordings: the likelihood of an observer's innovations, less a price for each parameter.
//!
//! A motor is driven by torques that no model knows, and read with noise. An observer corrects the model at readings about one time
//! constant of the motor apart; what is left there before it is corrected, the innovation, is white if the model is right (R. E.
//! Kalman, *J. Basic Eng.* 82, 35, 1960; L. Ljung, *System Identification*, 2nd ed., 1999, §7.4). The observer's gains follow
//! from the linear motor and two intensities of noise a recording, which are estimated once for each model that is accepted; so a model
//! costs as much as a free run. Where there is no torque noise the gains fall to nothing, and the innovations are the free run's errors.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `readings` | at which readings the observer corrects, and what each of them weighs |
//! | `noise` | the two intensities of each recording, by maximum likelihood |
//! | `gains` | the observer's gains and the variances of its innovations |
//! | `innovations` | the innovations of a model as a least-squares problem |
//! | `likelihood` | the likelihood of innovations |
//! | `foretold` | what is left in them that is no noise |
//! | `spread` | standard errors of parameters from its curvature |
//! | `repeatability` | how far the motor would be from its own repeat |

mod foretold;
mod gains;
mod innovations;
mod likelihood;
mod noise;
mod readings;
mod repeatability;
pub mod settings;
mod spread;
#[cfg(test)]
mod tests;

pub use foretold::{Foretold, foretold};
pub use gains::{Filter, Plant};
pub use innovations::{Innovations, Prior};
pub use likelihood::{correlation_length, likelihoods};
pub use noise::{Noise, estimate};
pub use readings::Readings;
pub use repeatability::repeatability_counts;
pub use spread::standard_errors;
