//! Which table and column of a log is which part of its file.

use crate::error::{FormatError, FormatFault};
use crate::log::{Column, Kind, Table};
use crate::origin::Origin;

/// Columns of one array; a wider one is an image and no record of signals.
pub(crate) const MOST_COLUMNS: u64 = 4096;
/// Columns of all tables together: a small file may claim any number of them.
const MOST_COLUMNS_OF_ALL: usize = 1 << 20;
/// Single values that are kept.
const MOST_FACTS: usize = 10_000;
/// Characters of a single text that is kept.
const LONGEST_FACT: usize = 4096;

/// Which axis of an array with two axes is time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Along {
    /// Its first axis: a row of the array is a row of the table.
    First,
    /// Its second axis: a row of the array is a column of the table.
    Second,
}

/// Where the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Source {
    /// The array, by the reader's own number.
    pub(crate) array: usize,
    /// Which of its columns.
    pub(crate) column: u64,
    /// Which axis is time.
    pub(crate) along: Along,
    /// What the values are.
    pub(crate) kind: Kind,
}

/// What a table is made of.
#[derive(Clone, Debug)]
enum Content {
    Columns(Vec<Source>),
    Unread { what: String, remedy: String },
}

/// The tables of a log, with the places of their columns, and the values that stand alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Plan {
    /// The tables.
    pub(crate) tables: Vec<Table>,
    /// Values that stand alone, as texts.
    pub(crate) facts: Vec<(String, String)>,
    contents: Vec<Content>,
    columns: usize,
}

impl Plan {
    /// Adds a table.
    pub(crate) fn table(
        &mut self,
        name: impl Into<String>,
        rows: u64,
        columns: Vec<(Column, Source)>,
    ) -> Result<(), FormatFault> {
        self.columns = self.columns.saturating_add(columns.len());
        if self.columns > MOST_COLUMNS_OF_ALL {
            return Err(FormatFault::TooLarge {
                what: "the list of columns".to_owned(),
                limit: MOST_COLUMNS_OF_ALL as u64,
            });
        }
        let (columns, sources) = columns.into_iter().unzip();
        self.tables.push(Table {
            name: name.into(),
            rows: Some(rows),
            columns,
        });
        self.contents.push(Content::Columns(sources));
        Ok(())
    }

    /// Lists what cannot be read, so that whoever looks for it is told why.
    pub(crate) fn unread(
        &mut self,
        name: impl Into<String>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) {
        self.tables.push(Table {
            name: name.into(),
            rows: None,
            columns: vec![Column {
                name: String::new(),
                kind: Kind::Text,
                unit: None,
            }],
        });
        let (what, remedy) = (what.into(), remedy.into());
        self.contents.push(Content::Unread { what, remedy });
    }

    /// Keeps a value that stands alone.
    pub(crate) fn fact(&mut self, name: impl Into<String>, value: impl Into<String>) {
        let (name, mut value) = (name.into(), value.into());
        if let Some((end, _)) = value.char_indices().nth(LONGEST_FACT) {
            value.truncate(end);
        }
        if self.facts.len() < MOST_FACTS {
            self.facts.push((name, value));
        }
    }

    /// Rows of a table and the places of some of its columns.
    pub(crate) fn sources(
        &self,
        origin: &Origin,
        table: usize,
        columns: &[usize],
    ) -> Result<(u64, Vec<Source>), FormatError> {
        let (Some(shown), Some(content)) = (self.tables.get(table), self.contents.get(table))
        else {
            return Err(origin.error(format!("table {table}"), FormatFault::Absent));
        };
        let sources = match content {
            Content::Columns(sources) => sources,
            Content::Unread { what, remedy } => {
                return Err(origin.unsupported(&shown.name, what, remedy));
            }
        };
        let chosen = columns.iter().map(|&at| match sources.get(at) {
            None => {
                let place = format!("{}: column {at}", shown.name);
                Err(origin.error(place, FormatFault::Absent))
            }
            Some(source) if source.kind == Kind::Text => {
                let name = shown.columns.get(at).map_or("", |column| &column.name);
                Err(origin.error(join(&shown.name, ": ", name), FormatFault::Text))
            }
            Some(source) => Ok(*source),
        });
        Ok((shown.rows.unwrap_or(0), chosen.collect::<Result<_, _>>()?))
    }
}

/// Two names with `between` them, or the one that is not empty.
pub(crate) fn join(first: &str, between: &str, second: &str) -> String {
    if first.is_empty() || second.is_empty() {
        format!("{first}{second}")
    } else {
        format!("{first}{between}{second}")
    }
}
