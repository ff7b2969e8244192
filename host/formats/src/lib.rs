//! What a log of any usual format holds: its tables, their columns, and the numbers in them.
//!
//! Nothing here knows what a motor is. A format is told by the content of a file and never by its name; whatever is damaged
//! gives one error with its place; memory is bounded by the rows that are read at a time and by what an index needs.
//!
//! | file | holds |
//! |---|---|
//! | `log` | a log, its tables and columns |
//! | `error` | what may be wrong with a file |
//! | `detect` | which format a file has |
//! | `batch` | rows that are collected from records |
//! | `bytes` | numbers and texts of a record |
//! | `shape` | structured messages as columns |
//! | `parquet` | Parquet |
//! | `lerobot` | datasets of LeRobot |
//! | `mcap` | MCAP, with messages of ROS, JSON and protobuf |
//! | `wpilog` | data logs of WPILib |
//! | `guard` | crates that panic at damage |
//! | `compressed` | texts in gzip and zstd |
//! | `numpy` | NumPy's arrays |
//! | `matlab` | MATLAB's files of level 5 |
//! | `hdf5` | HDF5, and MATLAB's files of version 7.3 |
//! | `json` | JSON, JSON lines and WPILib's SysId |
//! | `number` | numbers as bytes |
//! | `window` | parts of one open file that are read side by side |
//! | `plan` | which table and column of a log is which part of its file |
//! | `together` | which arrays were sampled together |
//! | `origin` | the file that errors are about |
#![forbid(unsafe_code)]

mod batch;
mod bytes;
mod compressed;
mod detect;
mod error;
mod guard;
mod hdf5;
mod json;
mod lerobot;
mod log;
mod matlab;
mod mcap;
mod number;
mod numpy;
mod origin;
mod parquet;
mod plan;
mod shape;
mod together;
mod window;
mod wpilog;

pub use compressed::{decompressed, decompressed_from};
pub use detect::{Format, open};
pub use error::{FormatError, FormatFault};
pub use log::{Column, Kind, Log, Rows, Table};
