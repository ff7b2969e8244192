//! The host side of servoid: recordings in, models and verdicts out.
//!
//! The flow, which is also the order to read the modules in:
//! `recording → units → model (motor + effects + encoder) → cost → optimiser → fit → residual →
//! diagnosis → report`.
#![forbid(unsafe_code)]

pub mod bench;
pub mod cli;
pub mod cmd;
pub mod compare;
pub mod device;
pub mod diagnose;
pub mod error;
pub mod export;
pub mod fit;
pub mod input;
pub mod kept;
pub mod lanes;
pub mod output;
pub mod page;
pub mod paper;
pub mod picture;
pub mod plan;
pub mod plot;
pub mod problem;
pub mod prove;
pub mod recording;
pub mod report;
pub mod session;
pub mod showcase;
pub mod solve;
pub mod workbench;
