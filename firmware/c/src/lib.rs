//! The fit of `shared` for firmwares in C: `include/servoid.h` declares it, README.md beside it tells how to use it.
//!
//! ```text
//! recording → servoid_fit_* → outcome → servoid_predict_* → verdict → servoid_servo_* → duties
//! ```
//!
//! The caller's memory holds everything; nothing is allocated. Every function says by its status if it was called too early, without memory,
//! or with nothing to fit. All is in the device's own measure: counts, periods, and parts of the supply.
//!
//! C hands over addresses, so these functions are unsafe: what they point to must be as the header says.

#![cfg_attr(target_os = "none", no_std)]

mod fit;
#[cfg(target_os = "none")]
mod panicking;
mod predict;
mod recording;
mod servo;
mod status;

pub use fit::{
    ServoidEstimate, ServoidFit, ServoidOutcome, ServoidSettings, servoid_fit_begin,
    servoid_fit_outcome, servoid_fit_work, servoid_usual_settings,
};
pub use predict::{
    ServoidGrade, ServoidReason, ServoidVerdict, servoid_predict_begin, servoid_predict_catch_up,
    servoid_predict_observe, servoid_verdict,
};
pub use recording::{SERVOID_OPEN, ServoidRecording};
pub use servo::{
    ServoidServo, servoid_servo_acts, servoid_servo_begin, servoid_servo_next,
    servoid_servo_settling, servoid_servo_turn,
};
pub use status::ServoidStatus;
