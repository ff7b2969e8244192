//! What device and host say to each other, defined once.
//!
//! ```text
//! message → postcard → CRC-32 → COBS → bytes, ended by a zero
//! ```
//!
//! Raw counts and duties travel; what they mean in SI is the host's business. [`VERSION`] counts changes that an older
//! peer would misread. Messages and their fields are only ever appended; a frame that does not decode (noise, a message of
//! a newer version) is dropped and counted, and the next zero byte starts afresh.

mod fault;
mod frame;
mod message;
mod reset;

pub use fault::Fault;
pub use frame::{Deframer, LONGEST_FRAME, encode};
pub use message::{
    About, Failure, Format, Job, Kind, Limits, MOST_ROWS, MOST_SEGMENTS, Refusal, Report, Row,
    Rows, Segment, Stage, ToDevice, ToHost, Verified,
};
pub use reset::Reset;

/// Version of the messages.
pub const VERSION: u16 = 2;
