//! Readers of foreign data. Nothing here trusts its input: what is wrong is refused with its place and
//! the remedy, and what is accepted keeps the promises of [`Recording`](crate::recording::Recording).
//!
//! `recording.csv → lines → row → layout (which column is what) → cells → counts → Recording`, with the
//! facts of `motor.toml` beside it.

mod cell;
mod counts;
mod csv_file;
mod excitation;
mod layout;
mod lines;
mod motor_error;
mod motor_file;
mod motor_text;
mod motor_units;
mod place;
mod read_error;
mod row;
mod section;
pub mod suggest;

pub use csv_file::{MAX_ROWS, read_recording, read_recording_from};
pub use excitation::MIN_TRAVEL_COUNTS;
pub use lines::MAX_LINE_BYTES;
pub use motor_error::{MotorFault, MotorFileError};
pub use motor_file::{Columns, Fact, Known, MAX_FILE_BYTES, MotorFile};
pub use motor_units::{AngleUnit, CommandUnit, CurrentUnit, TimeUnit, Units};
pub use place::{Cell, Place};
pub use read_error::{MissingColumn, ReadError, ReadFault};
