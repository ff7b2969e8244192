//! Results: the files that every verb writes and reads, and what people see of them.
//!
//! | module | holds |
//! |---|---|
//! | `schema` | the JSON of every verb: each type once, written and read |
//! | `device_run` | a run of a device as a folder of files |
//! | `report` | one result, one writer a format: text, JSON, page |
//! | `number_text` | numbers as people read them |
//! | `palette` | colours of all drawings |
//! | `page`, `picture` | an HTML file of words, tables and interactive drawings |
//! | `plot` | drawings as SVG |
//! | `export` | what was found for other programs |
//! | `remedy` | what knowing the effects is good for: a speed loop with and without their compensation |
//! | `reference` | the JSON as JSON Schema |
//! | `error` | why a result cannot be shown |
#![forbid(unsafe_code)]

pub mod device_run;
pub mod error;
pub mod export;
pub mod number_text;
pub mod page;
pub(crate) mod palette;
pub mod picture;
pub mod plot;
pub mod reference;
pub mod remedy;
pub mod report;
pub mod schema;

pub use error::Error;
