//! The file of finished cases: a line of JSON that says what they are, then one for each case.
//!
//! A line is appended whole when its case is finished, so that a killed run loses nothing but the cases
//! under way; a last line without its end is such a case, and is done again.

use super::Outcome;
use super::content::{finished, parse};
use super::header::{HEADER, Header};
use super::store_error::{Fault, StoreError, unreadable, wrong};
use serde::Serialize;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that cases are appended to.
#[derive(Debug)]
pub struct Store {
    file: File,
    path: PathBuf,
}

impl Store {
    /// A new file.
    ///
    /// # Errors
    /// A file that is there and not empty; what the system refuses.
    pub fn create(path: &Path, header: &Header) -> Result<Store, StoreError> {
        let wrong = wrong(path);
        let there = std::fs::metadata(path);
        if there.is_ok_and(|there| there.is_file() && there.len() > 0) {
            return Err(wrong(Fault::Exists));
        }
        let mut store = Store::open(path, OpenOptions::new().append(true).create(true))?;
        store.write(header)?;
        Ok(store)
    }

    /// An existing file, its finished cases, and place for more. A line that was not finished is cut off.
    ///
    /// # Errors
    /// As [`read`](super::read); cases of another set-up, or drawn in another way than this program does.
    pub fn resume(path: &Path, header: &Header) -> Result<(Store, Vec<Outcome>), StoreError> {
        let mut store = Store::open(path, OpenOptions::new().append(true))?;
        let wrong = wrong(path);
        let bytes = std::fs::read(path).map_err(|error| wrong(unreadable(error)))?;
        let whole = finished(&bytes);
        // What is to be cut must be a file of this kind first.
        let begun = bytes.iter().zip(HEADER.as_bytes()).all(|(a, b)| a == b);
        if whole.is_empty() && !begun {
            return Err(wrong(Fault::NoHeader));
        }
        let outcomes = match whole.is_empty() {
            true => Vec::new(),
            false => resumed(path, whole, header)?,
        };
        let length = whole.len() as u64;
        let cut = store.file.set_len(length);
        cut.map_err(|error| wrong(Fault::Io(error)))?;
        if whole.is_empty() {
            store.write(header)?;
        }
        Ok((store, outcomes))
    }

    /// Adds a finished case.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn append(&mut self, outcome: &Outcome) -> Result<(), StoreError> {
        self.write(outcome)
    }

    fn open(path: &Path, options: &OpenOptions) -> Result<Store, StoreError> {
        let wrong = wrong(path);
        let file = options
            .open(path)
            .map_err(|error| wrong(unreadable(error)))?;
        // Where the system knows no locks, two runs at one file are the user's care.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(wrong(Fault::Busy));
        }
        Ok(Store {
            file,
            path: path.to_owned(),
        })
    }

    /// One line, in one piece.
    fn write(&mut self, value: &impl Serialize) -> Result<(), StoreError> {
        let line = serde_json::to_string(value).map_err(io::Error::from);
        line.and_then(|line| {
            self.file.write_all(format!("{line}\n").as_bytes())?;
            self.file.flush()
        })
        .map_err(|error| wrong(&self.path)(Fault::Io(error)))
    }
}

/// The cases of a file that is to be continued under `header`.
fn resumed(path: &Path, lines: &[u8], header: &Header) -> Result<Vec<Outcome>, StoreError> {
    let content = parse(path, lines)?;
    if let Some(difference) = header.difference(&content.header) {
        return Err(wrong(path)(Fault::Other(difference)));
    }
    let mut outcomes = content.outcomes.iter();
    match outcomes.find(|outcome| !outcome.is_drawn_from(&header.set_up)) {
        Some(other) => Err(wrong(path)(Fault::Differs(
            other.case,
            "this program draws it",
        ))),
        None => Ok(content.outcomes),
    }
}
