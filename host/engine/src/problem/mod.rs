//! A recording and a model with unknowns, as a cost over the unit cube.
//!
//! [`data`] lowers a recording to what the model takes; [`unknowns`] says which numbers are
//! searched for and what they mean; [`simulate`] makes a candidate's models, [`course`] runs them along the
//! data, [`abreast`] several candidates at a time; [`cost`] sums, [`quick`] many samples at a time where commands are
//! [`held`].

pub mod abreast;
mod compress;
pub mod cost;
pub mod course;
pub mod data;
pub mod held;
mod nearby;
pub mod quick;
mod settling;
pub mod simulate;
mod spread;
pub mod unknowns;

pub use cost::{FitProblem, Horizon, StartAngle};
pub use data::Data;
pub use nearby::About;
pub use quick::Quick;
pub use simulate::Candidate;
pub use spread::Spread;
pub use unknowns::{Base, Structure, Unknown};
