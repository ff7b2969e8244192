//! Readers of foreign data. Nothing here trusts its input: what is wrong is refused with its place and
//! the remedy, and what is accepted keeps the promises of [`Recording`](crate::recording::Recording).
//!
//! `recording.csv → dialect → lines → row → layout (which column is what) → cells → counts → Recording`, with the
//! facts of `motor.toml` beside it. Columns that are in memory already go the same way from their numbers on (`arrays`), and so
//! do the tables of logs in other formats (`log_file`).

mod arrays;
mod bridge_off;
mod candidates;
mod cell;
mod cells;
mod clock;
mod collector;
mod counts;
mod csv_file;
mod dialect;
mod direction;
mod envelope;
mod excitation;
mod filtered;
mod finder;
mod finished;
mod gaps;
mod jumps;
mod keyed;
mod layout;
mod lines;
#[cfg(feature = "formats")]
mod log_file;
mod log_part;
#[cfg(feature = "formats")]
mod log_table;
mod missing;
mod motor_drive;
mod motor_error;
mod motor_file;
mod motor_parse;
mod motor_units;
mod motor_write;
mod names;
mod open;
mod order;
mod part;
mod place;
mod preset;
mod profile;
mod proposal;
mod quantity;
mod reached;
mod read_error;
mod reading;
mod row;
mod row_reader;
mod samples;
mod scale;
mod section;
mod shown;
mod speed;
mod spike;
mod stamps;
mod steady_curve;
pub mod suggest;
mod survey;
mod text_rows;
mod turns;
mod units_told;
mod values;

pub use arrays::{Arrays, recording_of};
pub use csv_file::{MAX_ROWS, read_recording_from};
pub use envelope::{Bin, Envelope};
pub use excitation::MIN_TRAVEL_COUNTS;
pub use lines::MAX_LINE_BYTES;
pub use log_part::{LogPart, Selection};
pub use missing::{Advice, MissingColumn, for_shell};
pub use motor_drive::DriveKind;
pub use motor_error::{MotorFault, MotorFileError};
pub use motor_file::{Columns, Fact, Known, MAX_FILE_BYTES, MotorFile};
pub use motor_units::{AngleUnit, CommandUnit, Reversed, SpeedUnit, TimeUnit, Units};
pub use open::{read_as_said, read_one, read_recording, read_recordings, read_recordings_with};
pub use part::Part;
pub use place::{Cell, Place};
pub use preset::{PRESETS, Preset};
pub use profile::Profile;
pub use proposal::{Need, Proposal, Proposed};
pub use reached::Reached;
pub use read_error::{ReadError, ReadFault};
pub use reading::Reading;
pub use steady_curve::{CurveError, SteadyCurve};
pub use survey::{Survey, SurveyColumn, SurveyTable, survey};
