//! A servo out of a fitted motor: gains, the loop that they are for, and how a step of it is judged.
//!
//! ```text
//! fit → gains → servo: count → observer → position and speed loop → duty
//!                 └── the same loop on the fitted motor, which predicts the step → response
//! ```
//!
//! All is in the device's own measure, as in [`fit`](crate::fit): counts, periods, and parts of the supply.

mod controller;
mod gains;
mod response;

pub use controller::{Servo, Target};
pub use gains::Gains;
pub use response::{Response, Step};
