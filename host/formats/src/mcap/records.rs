//! The records of an MCAP file, one after the other, those within chunks among them.
//!
//! The crate `mcap` is not used: it reserves as many bytes as a damaged length says, and its count of the bytes of a chunk
//! runs below zero.

use super::chunk::Chunk;
use crate::bytes::Bytes;
use crate::error::{FormatError, FormatFault};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::ops::ControlFlow;
use std::path::Path;

/// First bytes of an MCAP file, and its last.
pub(crate) const MAGIC: &[u8; 8] = b"\x89MCAP0\r\n";

/// What a record is.
pub(super) mod op {
    pub(crate) const FOOTER: u8 = 0x02;
    pub(crate) const SCHEMA: u8 = 0x03;
    pub(crate) const CHANNEL: u8 = 0x04;
    pub(crate) const MESSAGE: u8 = 0x05;
    pub(crate) const CHUNK: u8 = 0x06;
    pub(crate) const STATISTICS: u8 = 0x0b;
    pub(crate) const DATA_END: u8 = 0x0f;
}

/// Bytes of a record, or of the records of a chunk.
pub(super) const MOST_BYTES: u64 = 256 << 20;
/// An opcode and a length.
const HEAD: u64 = 9;
/// The footer with its head, and the magic after it.
const END: u64 = HEAD + 20 + 8;

/// Who takes the records: the kind of each, and its content.
pub(super) type EachRecord<'e> =
    &'e mut dyn FnMut(u8, &[u8]) -> Result<ControlFlow<()>, FormatError>;

/// An open file.
pub(super) struct Records {
    source: String,
    file: BufReader<File>,
    length: u64,
}

impl Records {
    pub(super) fn open(path: &Path) -> Result<Self, FormatError> {
        let source = path.display().to_string();
        let fail = |error: io::Error| FormatError::new(&source, "", error);
        let file = File::open(path).map_err(fail)?;
        let length = file.metadata().map_err(fail)?.len();
        Ok(Records {
            source,
            file: BufReader::new(file),
            length,
        })
    }

    pub(super) fn source(&self) -> &str {
        &self.source
    }

    /// Gives all records of the data until `each` breaks; those of chunks in the chunk's place.
    pub(super) fn data(&mut self, each: EachRecord<'_>) -> Result<(), FormatError> {
        self.walk(MAGIC.len() as u64, each)
    }

    /// Gives the records of the summary; none where the file has no summary that is whole.
    pub(super) fn summary(&mut self, each: EachRecord<'_>) -> Result<(), FormatError> {
        match self.summary_start() {
            Some(start) => self.walk(start, each),
            None => Ok(()),
        }
    }

    fn summary_start(&mut self) -> Option<u64> {
        let mut end = Vec::new();
        let from = self.length.checked_sub(END)?;
        self.file.seek(SeekFrom::Start(from)).ok()?;
        self.file.read_to_end(&mut end).ok()?;
        let mut bytes = Bytes::new(&end);
        let is_footer = bytes.u8()? == op::FOOTER && bytes.u64()? == 20;
        let start = bytes.u64()?;
        let is_there = start >= MAGIC.len() as u64 && start < from;
        (is_footer && is_there && end.ends_with(MAGIC)).then_some(start)
    }

    fn walk(&mut self, from: u64, each: EachRecord<'_>) -> Result<(), FormatError> {
        let mut at = from;
        let seek = self.file.seek(SeekFrom::Start(from));
        seek.map_err(|error| self.fail(at, error.into()))?;
        while let Some(next) = self.record(at, each)? {
            at = next;
        }
        Ok(())
    }

    /// Gives the record at the byte `at`; where the next one begins, if it is wanted.
    fn record(&mut self, at: u64, each: EachRecord<'_>) -> Result<Option<u64>, FormatError> {
        let left = self.length.saturating_sub(at);
        if left < HEAD {
            let what = if left == 0 {
                "the recording, which was not closed"
            } else {
                "a record"
            };
            return Err(self.fail(at, FormatFault::CutShort { what }));
        }
        let mut head = [0; HEAD as usize];
        let read = self.file.read_exact(&mut head);
        read.map_err(|error| self.fail(at, error.into()))?;
        let mut bytes = Bytes::new(&head);
        let (opcode, length) = (bytes.u8().unwrap_or(0), bytes.u64().unwrap_or(0));
        let left = left - HEAD;
        let next = at.saturating_add(HEAD).saturating_add(length);
        let flow = match opcode {
            0 => return Err(self.fail(at, damaged("a record has the opcode 0"))),
            op::CHUNK => {
                let chunk = Chunk::read(&mut self.file, length, left);
                let chunk = chunk.map_err(|fault| self.fail(at, fault))?;
                let flow = self.within(at, &chunk, each)?;
                if let (Some(fault), ControlFlow::Continue(())) = (chunk.fault, flow) {
                    return Err(self.fail(at, fault));
                }
                let seek = self.file.seek(SeekFrom::Start(next));
                seek.map_err(|error| self.fail(at, error.into()))?;
                flow
            }
            _ if length > left => {
                let what = "a record";
                return Err(self.fail(at, FormatFault::CutShort { what }));
            }
            op::FOOTER | op::SCHEMA | op::CHANNEL | op::MESSAGE | op::STATISTICS | op::DATA_END => {
                if length > MOST_BYTES {
                    return Err(self.fail(at, too_large("a record")));
                }
                let mut body = Vec::new();
                let read = (&mut self.file).take(length).read_to_end(&mut body);
                read.map_err(|error| self.fail(at, error.into()))?;
                each(opcode, &body)?
            }
            // Indices and attachments.
            _ => {
                let skip = i64::try_from(length).unwrap_or(i64::MAX);
                let skipped = self.file.seek_relative(skip);
                skipped.map_err(|error| self.fail(at, error.into()))?;
                ControlFlow::Continue(())
            }
        };
        let goes_on = flow.is_continue() && opcode != op::FOOTER && opcode != op::DATA_END;
        Ok(goes_on.then_some(next))
    }

    fn within(
        &self,
        at: u64,
        chunk: &Chunk,
        each: EachRecord<'_>,
    ) -> Result<ControlFlow<()>, FormatError> {
        let mut bytes = Bytes::new(&chunk.records);
        while !bytes.rest().is_empty() {
            let record = (|| {
                let (opcode, length) = (bytes.u8()?, bytes.u64()?);
                Some((opcode, bytes.take(usize::try_from(length).ok()?)?))
            })();
            let Some((opcode, body)) = record else {
                // Of a chunk that was cut short, this is where it was cut.
                if chunk.fault.is_some() {
                    break;
                }
                return Err(self.fail(at, damaged("a chunk ends in the middle of a record")));
            };
            let flow = each(opcode, body)?;
            if flow.is_break() {
                return Ok(flow);
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    fn fail(&self, at: u64, fault: FormatFault) -> FormatError {
        FormatError::new(&self.source, format!("byte {at}"), fault)
    }
}

/// What is wrong with the content of an MCAP file.
pub(super) fn damaged(why: impl Into<String>) -> FormatFault {
    FormatFault::Damaged {
        format: "MCAP file",
        why: why.into(),
    }
}

pub(super) fn too_large(what: &str) -> FormatFault {
    FormatFault::TooLarge {
        what: what.to_owned(),
        limit: MOST_BYTES,
    }
}
