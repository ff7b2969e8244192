//! The host side of servoid.
#![forbid(unsafe_code)]

pub mod recording;
pub mod solve;
