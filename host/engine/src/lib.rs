//! The engine of servoid: many simulations of a model along a recording, and the searches that use them.
//!
//! Each module knows only those before it:
//!
//! | module | holds |
//! |---|---|
//! | `data` | a recording in per-unit commands, counts and lengths of intervals |
//! | `lanes` | a number that holds several candidates, in SIMD registers |
//! | `simulation` | a model run along the data: one candidate, or several in lanes |
//! | `solve` | search methods behind one trait, every model evaluation counted |
//! | `problem` | data and a model with unknowns, as a cost over the unit cube |
//! | `block_cost` | the same cost in closed form, many samples at a time, for a linear motor whose commands are held |
//! | `compare` | methods times seeds at an equal budget |
#![forbid(unsafe_code)]

pub mod block_cost;
pub mod compare;
pub mod data;
pub mod lanes;
pub mod problem;
pub mod simulation;
pub mod solve;
