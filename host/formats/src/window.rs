//! Parts of one open file that are read side by side.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Arc, Mutex};

/// A part of an open file, with a position of its own.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    file: Arc<Mutex<File>>,
    start: u64,
    end: u64,
    at: u64,
}

impl Window {
    /// The whole of a file.
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let end = file.metadata()?.len();
        Ok(Window {
            file: Arc::new(Mutex::new(file)),
            start: 0,
            end,
            at: 0,
        })
    }

    /// Its bytes.
    pub(crate) fn length(&self) -> u64 {
        self.end - self.start
    }

    /// The part from byte `from` to byte `to`, as far as there are that many.
    pub(crate) fn part(&self, from: u64, to: u64) -> Self {
        let end = self.start.saturating_add(to).min(self.end);
        let start = self.start.saturating_add(from).min(end);
        Window {
            file: Arc::clone(&self.file),
            start,
            end,
            at: start,
        }
    }
}

impl Read for Window {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = usize::try_from(self.end.saturating_sub(self.at)).unwrap_or(usize::MAX);
        let most = buffer.len().min(left);
        let Some(buffer) = buffer.get_mut(..most) else {
            return Ok(0);
        };
        let mut file = self
            .file
            .lock()
            .map_err(|_| io::Error::other("a reader of this file failed before"))?;
        file.seek(SeekFrom::Start(self.at))?;
        let read = file.read(buffer)?;
        self.at += read as u64;
        Ok(read)
    }
}

impl Seek for Window {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let at = match to {
            SeekFrom::Start(at) => self.start.checked_add(at),
            SeekFrom::Current(by) => self.at.checked_add_signed(by),
            SeekFrom::End(by) => self.end.checked_add_signed(by),
        };
        let outside = || io::Error::from(io::ErrorKind::InvalidInput);
        self.at = at.filter(|at| *at >= self.start).ok_or_else(outside)?;
        Ok(self.at - self.start)
    }
}
