//! The device on the other side of a wire: talk to it, have it commission a motor, and check what it found.
//!
//! ```text
//! port → conversation → run → files        files → replay (same bits?) → stronger fit → verdict
//! emulation: an image of the firmware and the virtual bench, in lock step
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `port` | serial port, TCP or Unix socket, by one address |
//! | `conversation` | messages there and back, arming and starting |
//! | `duty` | what the device's duties are worth in volts |
//! | `order` | a job in SI, and the same in the device's own measure |
//! | `run` | one run: what the device sends, put together; progress; stop |
//! | `folder` | a run as files: recordings any verb reads, and what the device reported |
//! | `replay` | the device's fit once more on the host |
//! | `emulation` | the firmware without hardware |
//! | `lockstep` | the virtual bench as the plant of an emulated board |

mod conversation;
mod duty;
mod emulation;
mod error;
mod folder;
mod lockstep;
mod order;
mod port;
mod replay;
mod run;

pub use conversation::Conversation;
pub use duty::DutyScale;
pub use emulation::{Emulation, Image};
pub use error::DeviceError;
pub use folder::{Folder, Saved, SavedOutcome};
pub use lockstep::plant;
pub use order::{Order, segments};
pub use port::{Link, Port, serial_ports};
pub use replay::{Replayed, replay};
pub use run::{Progress, Recorded, Run, follow};
