//! All rows of a folder as one table, a few in memory at a time: the same table whoever made it, and in whatever order.

use crate::error::Error;
use crate::row::Row;
use crate::store::{PARTS, files, journals, read_journal, read_part, write_rows};
use std::collections::BTreeMap;
use std::iter::Peekable;
use std::path::Path;

type Rows = Box<dyn Iterator<Item = Result<Row, Error>>>;

/// Rows in the order of recording and key, each key once: a result stands before an error of the same key.
pub struct Merged {
    sources: Vec<Peekable<Rows>>,
}

impl Merged {
    /// The rows of a folder; without the results' JSON where that is not `whole`.
    ///
    /// # Errors
    /// A part that cannot be read.
    pub fn of(folder: &Path, whole: bool) -> Result<Self, Error> {
        let mut sources: Vec<Peekable<Rows>> = Vec::new();
        for path in files(&folder.join(PARTS))? {
            let rows: Rows = Box::new(read_part(&path, whole)?);
            sources.push(rows.peekable());
        }
        for path in journals(folder)? {
            let (mut rows, _) = read_journal(&path)?;
            rows.sort_by_key(Row::place);
            let rows: Rows = Box::new(rows.into_iter().map(Ok));
            sources.push(rows.peekable());
        }
        Ok(Merged { sources })
    }

    /// The source whose next row comes first; one that cannot be read comes before all.
    fn first(&mut self) -> Option<usize> {
        let mut first: Option<(usize, (String, String))> = None;
        for (source, rows) in self.sources.iter_mut().enumerate() {
            let place = match rows.peek() {
                None => continue,
                Some(Err(_)) => return Some(source),
                Some(Ok(row)) => row.place(),
            };
            if first.as_ref().is_none_or(|(_, least)| place < *least) {
                first = Some((source, place));
            }
        }
        first.map(|(source, _)| source)
    }
}

impl Iterator for Merged {
    type Item = Result<Row, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let first = self.first()?;
        let mut row = match self.sources[first].next()? {
            Err(error) => return Some(Err(error)),
            Ok(row) => row,
        };
        let place = row.place();
        for rows in &mut self.sources {
            let same =
                |next: &Result<Row, Error>| next.as_ref().is_ok_and(|next| next.place() == place);
            while let Some(Ok(other)) = rows.next_if(same) {
                if other.is_ok() && !row.is_ok() {
                    row = other;
                }
            }
        }
        Some(Ok(row))
    }
}

/// Rows of a folder by their verdict, their status, or the cause of their error.
///
/// # Errors
/// A part that cannot be read.
pub fn counted(folder: &Path) -> Result<BTreeMap<String, usize>, Error> {
    let mut counted = BTreeMap::new();
    for row in Merged::of(folder, false)? {
        let row = row?;
        let cause = row.cause.map(|cause| format!("error: {cause}"));
        let said = cause.or(row.verdict).unwrap_or(row.status);
        *counted.entry(said).or_insert(0) += 1;
    }
    Ok(counted)
}

/// Writes all rows of a folder as one Parquet file.
///
/// # Errors
/// A part that cannot be read; what the system refuses.
pub fn write_table(folder: &Path, path: &Path) -> Result<(), Error> {
    write_rows(path, Merged::of(folder, true)?)
}
