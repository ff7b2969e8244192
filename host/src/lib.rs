//! The host side of servoid.
#![forbid(unsafe_code)]

pub mod bench;
pub mod recording;
pub mod solve;
