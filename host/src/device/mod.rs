//! The host's side of a device: link, commissioning, and verification of its result.
//!
//! ```text
//! port → conversation → run → files        files → replay (same bits?) → stronger fit → verdict
//! emulation: an image of the firmware and the virtual bench, in lock step
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `port` | serial port, TCP or Unix socket, by one address |
//! | `conversation` | request and response, arming and starting |
//! | `order` | a job in SI and in the device's units |
//! | `course` | where a servo is to go, and when |
//! | `expected` | what a run can bring by its job: time, rows, numbers |
//! | `reached` | a device that can be talked to, real or emulated |
//! | `run` | one run: the device's messages assembled; progress; stop |
//! | `kept` | a run from its order to its files |
//! | `report` | the report of a run that `servoid_results::device_run` writes |
//! | `replay` | the device's fit repeated on the host |
//! | `emulation` | the firmware without hardware |
//! | `lockstep` | the virtual bench as the plant of an emulated board |

mod conversation;
mod course;
mod emulation;
mod error;
mod expected;
mod kept;
mod lockstep;
mod order;
mod port;
mod reached;
mod replay;
mod report;
mod run;

pub use conversation::{Clock, Conversation};
pub use course::{Aim, Course};
pub use emulation::{Emulation, Image};
pub use error::DeviceError;
pub use expected::Expected;
pub use kept::{Kept, drive, keep};
pub use lockstep::plant;
pub use order::{Order, segments};
pub use port::{Link, Port, serial_ports};
pub use reached::Reached;
pub use replay::{Replayed, replay};
pub use report::{broken, report};
pub use run::{Progress, Run, follow};
