//! Recordings of servoid: in memory, from foreign files, from the virtual bench, and back into files.
//!
//! | module | holds |
//! |---|---|
//! | `channel` | what a log may have a column of |
//! | `columns` | plain tables of numbers over time |
//! | `recording` | one recording in SI units and encoder counts |
//! | `position_loop` | from target angles to the volts of a drive that closes a position loop |
//! | `input` | readers of foreign CSV files and of `motor.toml` |
//! | `median` | the usual one of several values |
//! | `output` | files written whole or not at all |
//! | `excitation` | excitations by name, and what an amplifier is told by one |
//! | `record` | the virtual bench as a recorder |
//! | `showcase` | the recordings of a demonstration |
#![forbid(unsafe_code)]

pub mod channel;
pub mod columns;
pub mod excitation;
pub mod input;
pub mod median;
pub mod output;
pub mod position_loop;
pub mod record;
pub mod recording;
pub mod showcase;
