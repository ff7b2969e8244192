//! The program `servoid`: a command line, a workbench in the browser, and the host's side of a device.
//!
//! Layers, each a crate that knows only those before it: `servoid-plant` (the virtual bench), `servoid-io`, `servoid-engine`,
//! `servoid-identify`, `servoid-results`, and this one.
#![forbid(unsafe_code)]

pub mod cli;
pub mod cmd;
pub mod coverage;
pub mod device;
pub mod error;
mod interrupt;
pub mod prove;
pub mod session;
mod stated_law;
mod titled;
pub mod twins;
pub mod workbench;
