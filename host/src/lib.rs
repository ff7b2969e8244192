//! The host side of servoid.
#![forbid(unsafe_code)]

pub mod fit;
pub mod problem;
pub mod recording;
pub mod solve;
