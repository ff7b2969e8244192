//! Elements of a MATLAB file: a tag with type and size, and data.

use crate::number::{Class, Number};
use crate::window::Window;
use flate2::read::ZlibDecoder;
use std::io::{self, BufReader, ErrorKind, Read};

/// The type of an element that is a variable or a part of one.
pub(crate) const MATRIX: u32 = 14;
/// The type of an element that is compressed.
pub(crate) const COMPRESSED: u32 = 15;

/// The elements of one variable, read from its own tag on.
pub(crate) struct Stream {
    bytes: Bytes,
    /// The position, from the variable's tag on.
    at: u64,
    /// Whether the first byte of a number is the most significant one.
    pub(crate) big: bool,
}

enum Bytes {
    Plain(BufReader<Window>),
    Packed(Box<ZlibDecoder<Window>>),
}

/// The tag of an element.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tag {
    /// The type of its data.
    pub(crate) kind: u32,
    /// The bytes of its data.
    pub(crate) bytes: u64,
    /// Where its data begin.
    pub(crate) start: u64,
    /// Where the next element begins.
    pub(crate) next: u64,
}

/// Bytes that contradict the format.
pub(crate) fn damaged(why: impl Into<String>) -> io::Error {
    io::Error::new(ErrorKind::InvalidData, why.into())
}

impl Tag {
    /// How numbers of this type are written; `None` for a type that is no number.
    pub(crate) fn number(&self, big: bool) -> Option<Number> {
        let class = match self.kind {
            1 => Class::I8,
            2 => Class::U8,
            3 => Class::I16,
            4 => Class::U16,
            5 => Class::I32,
            6 => Class::U32,
            7 => Class::F32,
            9 => Class::F64,
            12 => Class::I64,
            13 => Class::U64,
            _ => return None,
        };
        Some(Number { class, big })
    }
}

impl Stream {
    /// The elements in `window`.
    pub(crate) fn new(window: Window, is_packed: bool, big: bool) -> Self {
        let bytes = if is_packed {
            Bytes::Packed(Box::new(ZlibDecoder::new(window)))
        } else {
            Bytes::Plain(BufReader::new(window))
        };
        Stream { bytes, at: 0, big }
    }

    /// Reads exactly `buffer`.
    pub(crate) fn fill(&mut self, buffer: &mut [u8]) -> io::Result<()> {
        match &mut self.bytes {
            Bytes::Plain(reader) => reader.read_exact(buffer)?,
            Bytes::Packed(reader) => reader.read_exact(buffer)?,
        }
        self.at = self.at.saturating_add(buffer.len() as u64);
        Ok(())
    }

    /// Goes on to the byte `to`.
    pub(crate) fn go_to(&mut self, to: u64) -> io::Result<()> {
        let by = to
            .checked_sub(self.at)
            .ok_or_else(|| damaged("a part is longer than the whole"))?;
        match &mut self.bytes {
            Bytes::Plain(reader) => {
                let by = i64::try_from(by).map_err(|_| damaged("a part is too long"))?;
                reader.seek_relative(by)?;
            }
            Bytes::Packed(reader) => {
                let skipped = io::copy(&mut reader.by_ref().take(by), &mut io::sink())?;
                if skipped < by {
                    return Err(ErrorKind::UnexpectedEof.into());
                }
            }
        }
        self.at = to;
        Ok(())
    }

    /// Reads the next tag; the element has to end before the byte `end`.
    pub(crate) fn tag(&mut self, end: u64) -> io::Result<Tag> {
        let mut first = [0; 4];
        self.fill(&mut first)?;
        let first = self.word(first);
        let (kind, short) = (first & 0xffff, first >> 16);
        let tag = if short == 0 {
            let mut bytes = [0; 4];
            self.fill(&mut bytes)?;
            let bytes = u64::from(self.word(bytes));
            let padded = match kind {
                COMPRESSED => bytes,
                _ => bytes.next_multiple_of(8),
            };
            Tag {
                kind,
                bytes,
                start: self.at,
                next: self.at.saturating_add(padded),
            }
        } else {
            Tag {
                kind,
                bytes: u64::from(short),
                start: self.at,
                next: self.at.saturating_add(4),
            }
        };
        let fits = short <= 4 && tag.start.saturating_add(tag.bytes) <= end;
        if !fits {
            return Err(damaged("a part is longer than the whole"));
        }
        Ok(tag)
    }

    /// Reads all data of an element of at most `most` bytes.
    pub(crate) fn data(&mut self, tag: Tag, most: u64) -> io::Result<Vec<u8>> {
        if tag.bytes > most {
            return Err(damaged(format!("a description has {} bytes", tag.bytes)));
        }
        let mut data = vec![0; usize::try_from(tag.bytes).unwrap_or(0)];
        self.fill(&mut data)?;
        self.go_to(tag.next)?;
        Ok(data)
    }

    /// Reads what is left of what is compressed, so that its checksum is verified.
    pub(crate) fn finish(self) -> io::Result<()> {
        if let Bytes::Packed(mut reader) = self.bytes {
            io::copy(&mut reader, &mut io::sink())?;
        }
        Ok(())
    }

    fn word(&self, bytes: [u8; 4]) -> u32 {
        if self.big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        }
    }
}
