//! Results: the files that every verb writes and reads, and what people see of them.
//!
//! | module | holds |
//! |---|---|
//! | `kept` | results read again from their JSON |
//! | `device_run` | a run of a device as a folder of files |
//! | `report` | one result, one writer a format: text, JSON, page |
//! | `page`, `picture` | an HTML file of words, tables and interactive drawings |
//! | `plot` | drawings as SVG |
//! | `export` | what was found for other programs |
//! | `error` | why a result cannot be shown |
#![forbid(unsafe_code)]

pub mod device_run;
pub mod error;
pub mod export;
pub mod kept;
pub mod page;
pub mod picture;
pub mod plot;
pub mod report;

pub use error::Error;
