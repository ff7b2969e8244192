//! A log: tables of columns.

use crate::detect::Format;
use crate::error::FormatError;
use std::ops::ControlFlow;

/// Rows that are handed on at a time, at most.
pub const ROWS_AT_A_TIME: usize = 4096;

/// One table of a log: columns of equal length that were sampled together.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Its name in the file: a topic, a variable, an episode; empty where the file has one table without a name.
    pub name: String,
    /// Its rows, where the file says so without being read to its end.
    pub rows: Option<u64>,
    /// Its columns.
    pub columns: Vec<Column>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name: `theta`, `position[2]`, `state.velocity`.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
    /// Its unit, where the file says it, as the file writes it.
    pub unit: Option<String>,
}

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Numbers.
    Number,
    /// Times, handed on as seconds since the first value of the column, or since the first record of a log whose tables have one
    /// clock (MCAP's `log_time`, WPILOG's `timestamp`).
    Time,
    /// True and false, handed on as 1 and 0.
    Flag,
    /// Texts, which are not handed on as numbers.
    Text,
}

/// Some rows of the columns that were asked for: one slice a column, all of equal length. What a row has no value for is NaN.
pub type Rows<'r> = &'r [Vec<f64>];

/// A log that is open.
pub trait Log {
    /// Its format.
    fn format(&self) -> Format;

    /// What is in it.
    fn tables(&self) -> &[Table];

    /// Values that stand alone in it, with their names: a mass, a gain, a note.
    fn facts(&self) -> &[(String, String)] {
        &[]
    }

    /// Hands on the rows of `columns` of the table with the index `table`, some at a time and in their order, until `each` breaks.
    ///
    /// # Errors
    /// The file is damaged there, a column holds texts, or there is no such table or column.
    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError>;
}
