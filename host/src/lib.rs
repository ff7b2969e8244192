//! The host side of servoid.
#![forbid(unsafe_code)]

pub mod input;
pub mod output;
pub mod recording;
pub mod solve;
