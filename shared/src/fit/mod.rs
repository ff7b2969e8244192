//! The fit on the device, a slice at a time: swarm or fireflies, then Levenberg and Marquardt's method.
//!
//! ```text
//! trace → space (what is searched, and where) → search → polish → outcome
//!              └── candidate → rigid motor → evaluation, so many samples a slice
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `settings` | what to search for, and how |
//! | `space`, `motor` | the unknowns and their ranges; a motor by their values |
//! | `slices`, `stage` | the fit: up to three searches, each with its polish; what shares memory |
//! | `evaluation`, `arithmetic` | a motor along a trace, in a number format |
//! | `polish`, `differences`, `cholesky` | Levenberg and Marquardt's method |
//! | `covariance`, `outcome` | how far the estimates may be off |
//! | `fitted`, `prediction`, `verdict` | what a fitted motor predicts, is good for, and makes |
//!
//! It searches over what voltage and angle determine: gain and the two time constants, in logarithms, and friction and
//! load if asked for. Behind a bridge with dead time the polish adds what that takes, and the viscous part of the damping; behind a supply
//! that is not measured, its resistance.
//! All is per supply, per period and in counts: a device need not know its supply voltage nor its encoder's resolution. The search itself is in f32 on every device; the model runs in `S`, f32 or fixed point. The same
//! trace, settings and `S` give the same bits anywhere, which is how the host checks a device.

mod arithmetic;
mod cholesky;
mod covariance;
mod differences;
mod evaluation;
mod fitted;
mod motor;
mod outcome;
mod polish;
mod prediction;
mod settings;
mod slices;
mod space;
mod stage;
mod verdict;

pub use arithmetic::Arithmetic;
pub use evaluation::Evaluation;
pub use motor::Motor;
pub use outcome::{Estimate, Outcome, Stop};
pub use prediction::{Predicted, Predictors};
pub use settings::{Method, POPULATION, Settings};
pub use slices::{Fit, SEARCHES};
pub use space::{MOST, Point, Space, Unknown};
pub use verdict::{Grade, Reason, Verdict};
