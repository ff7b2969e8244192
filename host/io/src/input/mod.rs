//! Readers of foreign data. Nothing here trusts its input: what is wrong is refused with its place and
//! the remedy, and what is accepted keeps the promises of [`Recording`](crate::recording::Recording).
//!
//! `recording.csv → lines → row → layout (which column is what) → cells → counts → Recording`, with the
//! facts of `motor.toml` beside it. Columns that are in memory already go the same way from their numbers on (`arrays`).

mod arrays;
mod cell;
mod counts;
mod csv_file;
mod excitation;
mod finder;
mod guess;
mod layout;
mod lines;
mod missing;
mod motor_drive;
mod motor_error;
mod motor_file;
mod motor_parse;
mod motor_units;
mod motor_write;
mod place;
mod preview;
mod read_error;
mod row;
mod sample;
mod samples;
mod scale;
mod section;
mod shown;
mod spike;
mod steady_curve;
pub mod suggest;

pub use arrays::{Arrays, recording_of};
pub use csv_file::{MAX_ROWS, read_recording, read_recording_from};
pub use excitation::MIN_TRAVEL_COUNTS;
pub use guess::{Guess, Sought, guess};
pub use lines::MAX_LINE_BYTES;
pub use missing::MissingColumn;
pub use motor_drive::DriveKind;
pub use motor_error::{MotorFault, MotorFileError};
pub use motor_file::{Columns, Fact, Known, MAX_FILE_BYTES, MotorFile};
pub use motor_units::{AngleUnit, CommandUnit, CurrentUnit, TimeUnit, Units};
pub use place::{Cell, Place};
pub use preview::{Preview, preview};
pub use read_error::{ReadError, ReadFault};
pub use steady_curve::{CurveError, SteadyCurve};
