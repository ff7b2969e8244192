//! The columns of rows that each have names of their own.

use super::cells::Cell;
use crate::log::{Column, Kind};
use std::collections::HashMap;

/// The columns that rows were seen to have, in the order in which they appeared.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schema {
    index: HashMap<String, usize>,
    columns: Vec<(String, Seen)>,
}

/// What kinds of values a column was seen to have.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    number: bool,
    flag: bool,
    text: bool,
}

impl Schema {
    /// The column at `path`, which is added if it is new and there are less than `most`.
    pub(crate) fn column(&mut self, path: &str, cell: Cell<'_>, most: usize) -> Option<usize> {
        let at = match self.index.get(path) {
            Some(&at) => at,
            None if self.columns.len() < most => {
                self.index.insert(path.to_owned(), self.columns.len());
                self.columns.push((path.to_owned(), Seen::default()));
                self.columns.len() - 1
            }
            None => return None,
        };
        if let Some((_, seen)) = self.columns.get_mut(at) {
            match cell {
                Cell::Number(_) => seen.number = true,
                Cell::Flag(_) => seen.flag = true,
                Cell::Text(_) => seen.text = true,
                Cell::Missing => {}
            }
        }
        Some(at)
    }

    /// The column at `path`, if there is one.
    pub(crate) fn find(&self, path: &str) -> Option<usize> {
        self.index.get(path).copied()
    }

    /// Columns.
    pub(crate) fn len(&self) -> usize {
        self.columns.len()
    }

    /// The path of a column.
    pub(crate) fn path(&self, column: usize) -> &str {
        self.columns.get(column).map_or("", |(path, _)| path)
    }

    /// What a column is: of texts only if it has no number.
    pub(crate) fn kind(&self, column: usize) -> Kind {
        match self.columns.get(column) {
            Some((_, seen)) if seen.number => Kind::Number,
            Some((_, seen)) if seen.text => Kind::Text,
            Some((_, seen)) if seen.flag => Kind::Flag,
            _ => Kind::Number,
        }
    }

    /// The columns as those of a table; a value without a path is called `[0]`.
    pub(crate) fn columns(&self) -> Vec<Column> {
        let column = |at| Column {
            name: match self.path(at) {
                "" => "[0]".to_owned(),
                path => path.to_owned(),
            },
            kind: self.kind(at),
            unit: None,
        };
        (0..self.len()).map(column).collect()
    }
}
