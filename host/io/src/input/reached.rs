//! How far a file was read.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Rows after which somebody who waits is told, where they come one by one.
pub(super) const ROWS_TO_TELL: u64 = 1 << 12;

/// How far a file was read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reached {
    /// Rows so far.
    pub rows: u64,
    /// The part of the file, from 0 to 1; `None` where its length is not known.
    pub part: Option<f64>,
}

impl Reached {
    /// So many rows, of as many as there are.
    pub(super) fn of(rows: u64, all: Option<u64>) -> Self {
        let part = all.filter(|all| *all > 0);
        let part = part.map(|all| (rows as f64 / all as f64).min(1.0));
        Reached { rows, part }
    }
}

/// A file whose bytes are counted as they are read.
pub(super) struct CountedFile {
    file: File,
    read: Arc<AtomicU64>,
}

/// The count of a [`CountedFile`], for whoever has given it away.
pub(super) struct Count {
    read: Arc<AtomicU64>,
    length: u64,
}

impl CountedFile {
    pub(super) fn open(path: &Path) -> io::Result<(Self, Count)> {
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let read = Arc::new(AtomicU64::new(0));
        let count = Count {
            read: Arc::clone(&read),
            length,
        };
        Ok((CountedFile { file, read }, count))
    }
}

impl Count {
    /// So many rows, of the bytes of the file. A pipe has no length.
    pub(super) fn reached(&self, rows: u64) -> Reached {
        let read = self.read.load(Ordering::Relaxed);
        let Reached { part, .. } = Reached::of(read, Some(self.length));
        Reached { rows, part }
    }
}

impl Read for CountedFile {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(into)?;
        self.read.fetch_add(read as u64, Ordering::Relaxed);
        Ok(read)
    }
}
