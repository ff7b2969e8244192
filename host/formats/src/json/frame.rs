//! A list of JSON as columns: one row an element.

use super::cells::{Cell, Sink};
use super::schema::Schema;
use crate::error::FormatFault;
use std::collections::HashMap;

/// Bytes of values and of the gaps between them, in all lists of a document.
const MOST_BYTES: u64 = 1 << 31;
/// Different names of values in one list. Signals may lie along either axis of a list of lists, so
/// that this may be as many as there are samples.
const MOST_NAMES: usize = 1 << 22;
/// Values and gaps that a byte of a document may stand for, and those that any document may have.
const VALUES_A_BYTE: u64 = 4;
const LEAST: u64 = 1 << 20;
/// What a name costs, in values.
pub(crate) const NAME: u64 = 24;

/// Elements of a list that is a series of samples.
const LEAST_SERIES: usize = 32;

/// The name of the series that a path is an element of, and its place in it: `angle[7]` is of `angle`, `q[7][1]` of `q[1]`.
fn series_of(path: &str) -> Option<(String, usize)> {
    let (name, behind) = path.split_once('[')?;
    let (at, rest) = behind.split_once(']')?;
    let place = at.parse().ok()?;
    (!name.is_empty()).then(|| (format!("{name}{rest}"), place))
}

/// A list as columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// The columns.
    pub(crate) schema: Schema,
    /// Elements of the list.
    pub(crate) rows: usize,
    values: Vec<Vec<f64>>,
}

impl Frame {
    /// The value of a column in a row.
    pub(crate) fn value(&self, column: usize, row: usize) -> f64 {
        let column = self.values.get(column);
        // A column ends with its last value.
        column
            .and_then(|values| values.get(row))
            .copied()
            .unwrap_or(f64::NAN)
    }

    /// How many values an element has, where the elements are single values or lists of them that
    /// are all of one kind.
    pub(crate) fn width(&self) -> Option<usize> {
        let width = self.schema.len();
        let is_single = width == 1 && self.schema.path(0).is_empty();
        let is_list = || (0..width).all(|at| self.schema.path(at) == format!("[{at}]"));
        let is_one_kind = || (1..width).all(|at| self.schema.kind(at) == self.schema.kind(0));
        (self.rows > 0 && width > 0 && (is_single || is_list()) && is_one_kind()).then_some(width)
    }

    /// Its elements as frames of their own, where each is an object that holds series, as rollouts are: the elements of a list are the rows
    /// then. `None` where no list is longer than there are elements.
    pub(crate) fn rollouts(&self) -> Option<Vec<Frame>> {
        // The columns of a series by its name, each with its place in the list.
        let mut names: Vec<String> = Vec::new();
        let mut series: HashMap<String, Vec<(usize, usize)>> = HashMap::new();
        for column in 0..self.schema.len() {
            let Some((name, at)) = series_of(self.schema.path(column)) else {
                continue;
            };
            let own = series.entry(name.clone()).or_insert_with(|| {
                names.push(name);
                Vec::new()
            });
            own.push((at, column));
        }
        let longest = series.values().map(Vec::len).max().unwrap_or(0);
        if longest < LEAST_SERIES || longest <= self.rows {
            return None;
        }
        let values = |name: &String, row: usize| -> Vec<f64> {
            let mut places = series.get(name).cloned().unwrap_or_default();
            places.sort_unstable();
            let values = places.iter().map(|(_, column)| self.value(*column, row));
            let mut values: Vec<f64> = values.collect();
            while values.last().is_some_and(|value| value.is_nan()) {
                values.pop();
            }
            values
        };
        let rollout = |row: usize| {
            let all: Vec<Vec<f64>> = names.iter().map(|name| values(name, row)).collect();
            let rows = all.iter().map(Vec::len).max().unwrap_or(0);
            let mut frame = Frame {
                rows,
                ..Frame::default()
            };
            for (name, values) in names.iter().zip(all) {
                if values.len() == rows && rows > 0 {
                    frame.schema.column(name, Cell::Number(0.0), MOST_NAMES);
                    frame.values.push(values);
                }
            }
            frame
        };
        Some((0..self.rows).map(rollout).collect())
    }

    /// Puts a value into the current row, which is the one behind the last.
    pub(crate) fn put(
        &mut self,
        path: &str,
        cell: Cell<'_>,
        room: &mut Room,
    ) -> Result<(), FormatFault> {
        let known = self.schema.len();
        let column = self.schema.column(path, cell, MOST_NAMES);
        let column = column.ok_or(FormatFault::TooLarge {
            what: "the list of names of values".to_owned(),
            limit: MOST_NAMES as u64,
        })?;
        if self.schema.len() > known {
            room.take(NAME)?;
        }
        let value = match cell {
            Cell::Number(value) => value,
            Cell::Flag(flag) => f64::from(u8::from(flag)),
            Cell::Text(_) | Cell::Missing => return Ok(()),
        };
        if self.values.len() <= column {
            self.values.resize_with(column + 1, Vec::new);
        }
        let Some(values) = self.values.get_mut(column) else {
            return Ok(());
        };
        room.take(self.rows.saturating_sub(values.len()) as u64 + 1)?;
        values.resize(self.rows, f64::NAN);
        values.push(value);
        Ok(())
    }
}

/// How much more a document may hold: rows that each have a name of their own leave gaps that no
/// byte of the file stands for.
#[derive(Debug)]
pub(crate) struct Room {
    left: u64,
    all: u64,
    /// Why a value was not taken.
    pub(crate) refused: Option<FormatFault>,
}

impl Room {
    /// The room of a document of so many bytes.
    pub(crate) fn of(bytes: u64) -> Self {
        let values = bytes.saturating_mul(VALUES_A_BYTE);
        let all = values.saturating_add(LEAST).min(MOST_BYTES / 8);
        Room {
            left: all,
            all,
            refused: None,
        }
    }

    /// Keeps why a value was not taken, since errors of serde are texts.
    pub(crate) fn refuse<E: serde::de::Error>(&mut self, fault: FormatFault) -> E {
        let text = fault.to_string();
        self.refused = Some(fault);
        E::custom(text)
    }

    /// Takes the room of so many values.
    pub(crate) fn take(&mut self, values: u64) -> Result<(), FormatFault> {
        let left = self.left.checked_sub(values);
        self.left = left.ok_or_else(|| FormatFault::TooLarge {
            what: "the document, with the values that its rows lack,".to_owned(),
            limit: 8 * self.all,
        })?;
        Ok(())
    }
}

/// Fills the current row of a list.
pub(crate) struct Filling<'f> {
    /// The list.
    pub(crate) frame: &'f mut Frame,
    /// What room is left.
    pub(crate) room: &'f mut Room,
}

impl Sink for Filling<'_> {
    fn cell(&mut self, path: &str, cell: Cell<'_>) -> Result<(), FormatFault> {
        self.frame.put(path, cell, self.room)
    }

    fn refuse(&mut self, fault: FormatFault) {
        self.room.refused = Some(fault);
    }
}
