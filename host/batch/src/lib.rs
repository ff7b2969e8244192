//! Many recordings: each is fitted or diagnosed by itself, and its result is one row of a table.
//!
//! ```text
//! input (a folder of logs, or Parquet) → unit → key → is it there? → work → row → journal → part
//! ```
//!
//! What is to be done is what is wanted less what is there: a run that was killed, a lot that has grown, another version and
//! `retry error` are one operation. Units are independent, so that several machines may each take a [`Shard`] into one folder.
//!
//! | file | holds |
//! |---|---|
//! | `input`, `columns` | the units: files of a folder, or rows of a Parquet file |
//! | `task` | what is done to each, and its result as a row |
//! | `key` | the name of a result: a digest of name, content, task, version and seed |
//! | `row` | one row, as results are written and read |
//! | `manifest` | what each run was asked for, and which parts it wrote |
//! | `store` | rows on disk: a journal that grows, and parts that are written whole |
//! | `table` | all rows of a folder as one table |
//! | `run` | the work, on all cores |
//! | `shard` | a part of the units, for one machine of several |
#![forbid(unsafe_code)]

mod columns;
mod error;
mod input;
mod key;
mod manifest;
mod row;
mod run;
mod shard;
mod store;
mod table;
mod task;

pub use error::Error;
pub use input::Input;
pub use manifest::{Part, Run, runs};
pub use row::{Labels, Parameter, Row};
pub use run::{Batch, Done, Watch, run};
pub use shard::{BadShard, Shard};
pub use store::Store;
pub use table::{Merged, counted, write_table};
pub use task::{Task, Verb};
