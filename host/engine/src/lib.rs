//! The engine of servoid: many simulations of a model along a recording, and the searches that use them.
//!
//! | module | holds |
//! |---|---|
//! | `lanes` | a number that holds several candidates, in SIMD registers |
//! | `problem` | a recording and a model with unknowns, as a cost over the unit cube |
//! | `solve` | search methods behind one trait, every model evaluation counted |
//! | `compare` | methods times seeds at an equal budget |
#![forbid(unsafe_code)]

pub mod compare;
pub mod lanes;
pub mod problem;
pub mod solve;
