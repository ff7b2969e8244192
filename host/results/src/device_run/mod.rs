//! A run of a device as a folder of files: recordings that every verb reads, and what the device reported.
//!
//! | file | holds |
//! |---|---|
//! | `folder` | the files, written and read |
//! | `recorded` | the periods that arrived, put together |
//! | `live`, `lines` | the rows of a run under way, on disk as they arrive |
//! | `duty` | what a device's duties are worth in volts |
//! | `error` | why a folder cannot be used |

mod duty;
mod error;
mod folder;
mod lines;
mod live;
mod recorded;

pub use duty::DutyScale;
pub use error::FolderError;
pub use folder::{Folder, recording};
pub use lines::{COLUMNS, Lines};
pub use live::Live;
pub use recorded::{Piece, Recorded};
