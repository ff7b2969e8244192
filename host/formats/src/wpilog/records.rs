//! The records of a data log of WPILib, one after the other, as version 1.0 of its specification says.
//!
//! The crates for it (`wpilog`, `wpilog-rs`) hold the whole file, and are not maintained.

use crate::bytes::Bytes;
use crate::error::{FormatError, FormatFault};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// First bytes of the file.
pub(crate) const MAGIC: &[u8; 6] = b"WPILOG";
/// Magic, version, and the length of a text that programs may add.
const HEADER: u64 = 12;

/// What comes before the content of a record.
#[derive(Clone, Copy, Debug)]
pub(super) struct Head {
    /// The entry that it is of; 0 where it says something of entries.
    pub(super) entry: u32,
    /// Bytes of its content.
    pub(super) size: u64,
    /// Microseconds.
    pub(super) time: u64,
    /// The byte where it begins.
    pub(super) at: u64,
}

/// An open file.
pub(super) struct Records {
    source: String,
    file: BufReader<File>,
    length: u64,
    /// The first record.
    start: u64,
    /// The next byte.
    at: u64,
}

impl Records {
    pub(super) fn open(path: &Path) -> Result<Self, FormatError> {
        let source = path.display().to_string();
        let fail = |fault: FormatFault| FormatError::new(&source, "byte 0", fault);
        let opened = File::open(path).and_then(|file| Ok((file.metadata()?.len(), file)));
        let (length, file) = opened.map_err(|error| fail(error.into()))?;
        let mut file = BufReader::new(file);
        let mut header = Vec::new();
        let read = (&mut file).take(HEADER).read_to_end(&mut header);
        read.map_err(|error| fail(error.into()))?;
        let mut bytes = Bytes::new(&header);
        let fields = (|| {
            bytes.take(MAGIC.len())?;
            Some((bytes.u8()?, bytes.u8()?, u64::from(bytes.u32()?)))
        })();
        let Some((minor, major, extra)) = fields else {
            return Err(fail(FormatFault::CutShort { what: "the header" }));
        };
        if major != 1 {
            return Err(fail(FormatFault::Unsupported {
                what: format!("version {major}.{minor} of a data log"),
                remedy: "open it with the program that made it, and write it as CSV".to_owned(),
            }));
        }
        let start = HEADER.saturating_add(extra);
        if start > length {
            return Err(fail(FormatFault::CutShort { what: "the header" }));
        }
        Ok(Records {
            source,
            file,
            length,
            start,
            at: start,
        })
    }

    pub(super) fn source(&self) -> &str {
        &self.source
    }

    /// Goes back to the first record.
    pub(super) fn rewind(&mut self) -> Result<(), FormatError> {
        self.at = self.start;
        let seek = self.file.seek(SeekFrom::Start(self.at));
        seek.map(|_| ())
            .map_err(|error| self.fail(self.start, error))
    }

    /// The head of the next record, whose content is there; none at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<Head>, FormatError> {
        let at = self.at;
        if at >= self.length {
            return Ok(None);
        }
        let mut lengths = [0];
        let read = self.file.read_exact(&mut lengths);
        read.map_err(|error| self.fail(at, error))?;
        let [lengths] = lengths;
        let entry = (lengths & 3) + 1;
        let size = ((lengths >> 2) & 3) + 1;
        let time = ((lengths >> 4) & 7) + 1;
        let head = 1 + u64::from(entry) + u64::from(size) + u64::from(time);
        let cut = FormatFault::CutShort { what: "a record" };
        if head > self.length - at {
            return Err(self.fail(at, cut));
        }
        let entry = self.whole(at, entry)?;
        let size = self.whole(at, size)?;
        let time = self.whole(at, time)?;
        self.at = at.saturating_add(head);
        if size > self.length.saturating_sub(self.at) {
            return Err(self.fail(at, cut));
        }
        Ok(Some(Head {
            // It has four bytes at most.
            entry: u32::try_from(entry).unwrap_or(u32::MAX),
            size,
            time,
            at,
        }))
    }

    /// Reads the first bytes of the content, `most` of them, and goes to the next record.
    pub(super) fn content(
        &mut self,
        head: Head,
        most: u64,
        content: &mut Vec<u8>,
    ) -> Result<(), FormatError> {
        content.clear();
        let wanted = head.size.min(most);
        let read = (&mut self.file).take(wanted).read_to_end(content);
        read.map_err(|error| self.fail(head.at, error))?;
        self.at = self.at.saturating_add(wanted);
        self.skip(head, head.size - wanted)
    }

    /// Goes over `count` bytes of the content.
    pub(super) fn skip(&mut self, head: Head, count: u64) -> Result<(), FormatError> {
        self.at = self.at.saturating_add(count);
        let skipped = self
            .file
            .seek_relative(i64::try_from(count).unwrap_or(i64::MAX));
        skipped.map_err(|error| self.fail(head.at, error))
    }

    /// A number of up to eight bytes.
    fn whole(&mut self, at: u64, bytes: u8) -> Result<u64, FormatError> {
        let mut number = [0; 8];
        if let Some(used) = number.get_mut(..usize::from(bytes)) {
            let read: io::Result<()> = self.file.read_exact(used);
            read.map_err(|error| self.fail(at, error))?;
        }
        Ok(u64::from_le_bytes(number))
    }

    pub(super) fn fail(&self, at: u64, fault: impl Into<FormatFault>) -> FormatError {
        FormatError::new(&self.source, format!("byte {at}"), fault)
    }
}

/// What is wrong with the content of a data log.
pub(super) fn damaged(why: impl Into<String>) -> FormatFault {
    FormatFault::Damaged {
        format: "WPILib data log",
        why: why.into(),
    }
}
