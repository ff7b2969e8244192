//! The program `servoid`: a command line, a workbench in the browser, and the host's side of a device.
//!
//! Layers, each a crate that knows only those before it: `servoid-plant` (the virtual bench), `servoid-io`, `servoid-engine`,
//! `servoid-identify`, `servoid-results`, and this one.
#![forbid(unsafe_code)]

pub mod cli;
pub mod cmd;
pub mod device;
pub mod error;
pub mod prove;
pub mod session;
pub mod workbench;

pub use servoid_engine::{block_cost, compare, data, lanes, problem, simulation, solve};
pub use servoid_identify::{diagnose, fit, likelihood, paper, plan, truth};
pub use servoid_io::{input, output, position_loop, recording, showcase};
pub use servoid_plant as bench;
pub use servoid_results::{export, page, picture, plot, report, schema};
