//! Plain tables of numbers over time: what servoid itself writes, or what a user writes for it.

use std::path::{Path, PathBuf};

/// A table that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}{}: {why}", .path.display(), .line.map_or_else(String::new, |line| format!(", line {line}")))]
pub struct ColumnsError {
    /// The file.
    pub path: PathBuf,
    /// Its line, from 1, where one is at fault.
    pub line: Option<u64>,
    /// What is wrong with it.
    pub why: String,
}

impl ColumnsError {
    /// Of a file as a whole.
    pub fn of(path: &Path, why: String) -> Self {
        ColumnsError {
            path: path.to_path_buf(),
            line: None,
            why,
        }
    }
}

/// Columns of a table, all of one length.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns<const N: usize> {
    /// Times, which increase, s.
    pub time_s: Vec<f64>,
    /// Those that were asked for; nothing for one that is not there.
    pub named: [Option<Vec<f64>>; N],
}

/// The columns of a table that have these names, and its times.
///
/// # Errors
/// A file that cannot be read, no column of times, a cell that is no number, times that do not increase; with file and line.
pub fn columns<const N: usize>(
    path: &Path,
    names: [&str; N],
    usual: &str,
) -> Result<Columns<N>, ColumnsError> {
    let wrong = |line: Option<u64>, why: String| ColumnsError {
        line,
        ..ColumnsError::of(path, why)
    };
    let reader = csv::ReaderBuilder::new()
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_path(path);
    let mut reader = reader.map_err(|error| wrong(None, error.to_string()))?;
    let header = reader
        .headers()
        .map_err(|error| wrong(None, error.to_string()))?
        .clone();
    let place = |name: &str| {
        header
            .iter()
            .position(|found| found.eq_ignore_ascii_case(name))
    };
    let time = place("t_s").ok_or_else(|| wrong(None, format!("no column `t_s`; {usual}")))?;
    let places = names.map(place);
    let mut read = Columns {
        time_s: Vec::new(),
        named: places.map(|place| place.map(|_| Vec::new())),
    };
    for record in reader.records() {
        let record = record
            .map_err(|error| wrong(error.position().map(csv::Position::line), error.to_string()))?;
        let line = record.position().map(csv::Position::line);
        let number = |column: usize| {
            let cell = record.get(column).unwrap_or("");
            let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| wrong(line, format!("`{cell}` is no number")))
        };
        let at = number(time)?;
        if read.time_s.last().is_some_and(|last| *last >= at) {
            return Err(wrong(line, format!("t_s {at} does not increase")));
        }
        read.time_s.push(at);
        for (column, place) in read.named.iter_mut().zip(places) {
            if let (Some(column), Some(place)) = (column, place) {
                column.push(number(place)?);
            }
        }
    }
    Ok(read)
}
