//! Rows on their way to who reads them.

use crate::error::{FormatError, FormatFault};
use crate::log::{Kind, ROWS_AT_A_TIME, Rows, Table};
use std::ops::ControlFlow;

/// Who takes the rows.
pub(crate) type Each<'e> = &'e mut dyn FnMut(Rows<'_>) -> ControlFlow<()>;

/// The table that is asked for, once it is sure that it has these columns and that they are no texts.
pub(crate) fn asked<'t>(
    source: &str,
    tables: &'t [Table],
    table: usize,
    columns: &[usize],
) -> Result<&'t Table, FormatError> {
    let Some(table) = tables.get(table) else {
        let place = format!("table {table}");
        return Err(FormatError::new(source, place, FormatFault::Absent));
    };
    for &column in columns {
        let Some(found) = table.columns.get(column) else {
            let place = place(&table.name, &format!("column {column}"));
            return Err(FormatError::new(source, place, FormatFault::Absent));
        };
        if found.kind == Kind::Text {
            let place = place(&table.name, &found.name);
            return Err(FormatError::new(source, place, FormatFault::Text));
        }
    }
    Ok(table)
}

/// A place in a table, for messages.
pub(crate) fn place(table: &str, within: &str) -> String {
    if table.is_empty() {
        within.to_owned()
    } else {
        format!("{table}: {within}")
    }
}

/// The first value of a column of times, from which the others are counted.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Start {
    /// No value yet.
    #[default]
    Open,
    /// Whole units.
    Ticks(i128),
    /// Seconds.
    Seconds(f64),
}

impl Start {
    /// Seconds since the first value of the column, subtracted before they lose digits.
    pub(crate) fn since(&mut self, ticks: i128, per_second: f64) -> f64 {
        match *self {
            Start::Ticks(first) => ticks.saturating_sub(first) as f64 / per_second,
            _ => {
                *self = Start::Ticks(ticks);
                0.0
            }
        }
    }

    /// The same of a time that is in seconds.
    pub(crate) fn since_seconds(&mut self, seconds: f64) -> f64 {
        match *self {
            Start::Seconds(first) => seconds - first,
            _ if seconds.is_finite() => {
                *self = Start::Seconds(seconds);
                0.0
            }
            _ => f64::NAN,
        }
    }
}

/// A value as a record holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    /// A number, or 0 and 1 of a flag.
    Number(f64),
    /// Nanoseconds since any moment.
    Nanoseconds(i128),
}

/// Rows that are collected one by one, from records.
pub(crate) struct Batch<'e> {
    columns: Vec<usize>,
    row: Vec<f64>,
    starts: Vec<Start>,
    rows: Vec<Vec<f64>>,
    each: Each<'e>,
}

impl<'e> Batch<'e> {
    /// Rows of a table of `width` columns, of which `columns` are wanted.
    pub(crate) fn new(width: usize, columns: &[usize], each: Each<'e>) -> Self {
        Batch {
            columns: columns.to_vec(),
            row: vec![f64::NAN; width],
            starts: vec![Start::Open; width],
            rows: vec![Vec::new(); columns.len()],
            each,
        }
    }

    /// Counts a column of times from a moment that tables of one log share, unless it has begun.
    pub(crate) fn counts_from(&mut self, column: usize, ticks: i128) {
        if let Some(start @ Start::Open) = self.starts.get_mut(column) {
            *start = Start::Ticks(ticks);
        }
    }

    /// A value of the row that is being made.
    pub(crate) fn set(&mut self, column: usize, value: Value) {
        let (Some(cell), Some(start)) = (self.row.get_mut(column), self.starts.get_mut(column))
        else {
            return;
        };
        *cell = match value {
            Value::Number(number) => number,
            Value::Nanoseconds(ticks) => start.since(ticks, 1e9),
        };
    }

    /// The row is complete.
    pub(crate) fn end_row(&mut self) -> ControlFlow<()> {
        for (column, rows) in self.columns.iter().zip(&mut self.rows) {
            rows.push(self.row.get(*column).copied().unwrap_or(f64::NAN));
        }
        self.row.fill(f64::NAN);
        if self.held() >= ROWS_AT_A_TIME {
            self.flush()
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Hands on what is held.
    pub(crate) fn flush(&mut self) -> ControlFlow<()> {
        if self.held() == 0 {
            return ControlFlow::Continue(());
        }
        let flow = (self.each)(&self.rows);
        for column in &mut self.rows {
            column.clear();
        }
        flow
    }

    fn held(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }
}
