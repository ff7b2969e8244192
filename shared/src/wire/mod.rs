//! What device and host say to each other, defined once.
//!
//! ```text
//! message → postcard → CRC-32 → COBS → bytes, ended by a zero
//! ```
//!
//! Raw counts and duties travel; what they mean in SI is the host's business. [`VERSION`] counts changes that an older
//! peer would misread. Messages and their fields are only ever appended; a frame that does not decode (noise, a message of
//! a newer version) is dropped and counted, and the next zero byte starts afresh.
//!
//! A link may lose, double and reorder frames. So whatever starts or makes up a motion is acknowledged, a list comes in numbered
//! parts and is named by its length and checksum, and what belongs to a run carries that run's nonce.

mod fault;
mod frame;
mod message;
mod plan;
mod reset;

pub use fault::Fault;
pub use frame::{CRC, Deframer, LONGEST_FRAME, encode};
pub use message::{
    About, Details, Failure, Format, Job, Kind, Limits, MOST_ROWS, Refusal, Report, Row, Rows,
    ServoState, SetPoint, Stage, ToDevice, ToHost, Tuned,
};
pub use plan::{MOST_SEGMENTS, PLAN_SEGMENTS, PlanDigest, PlanPart, PlanStore, Segment};
pub use reset::Reset;

/// Version of the messages.
pub const VERSION: u16 = 6;
