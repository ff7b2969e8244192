//! A recording and a model with unknowns, as a cost over the unit cube.
//!
//! [`data`] lowers a recording to what the model takes; [`unknowns`] says which numbers are
//! searched for and what they mean; [`simulate`] runs a candidate along the data; [`cost`] sums.

pub mod cost;
pub mod data;
pub mod simulate;
pub mod unknowns;

pub use cost::{FitProblem, Horizon, StartAngle};
pub use data::Data;
pub use simulate::Candidate;
pub use unknowns::{Base, Structure, Unknown};
