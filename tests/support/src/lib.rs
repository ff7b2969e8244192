//! What the tests of all crates share. [`recordings`] has the recordings measured by others, [`length`] says how much of a long law
//! is tried, what a test leaves out it says through [`left_out`], so that no runner swallows it, and [`motion`] steps the model.
#![forbid(unsafe_code)]

pub mod left_out;
pub mod length;
pub mod motion;
pub mod recordings;
