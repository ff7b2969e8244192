//! Lines of a text file, one at a time and of bounded length: a file of any size costs one line of memory.

use encoding_rs::WINDOWS_1252;
use std::io::{BufRead, Read};

use super::place::Place;
use super::read_error::{ReadError, ReadFault};

/// A longer line is no row of a recording.
pub const MAX_LINE_BYTES: usize = 1 << 20;

/// Reads the lines that carry data: comments (`#`) and blank lines are passed over, but counted.
pub(super) struct Lines<'s, R> {
    reader: R,
    source: &'s str,
    number: u64,
    line: Vec<u8>,
    ended: bool,
    /// The first line that was no UTF-8.
    recoded: Option<u64>,
}

impl<'s, R: BufRead> Lines<'s, R> {
    pub(super) fn new(reader: R, source: &'s str) -> Self {
        Lines {
            reader,
            source,
            number: 0,
            line: Vec::new(),
            ended: true,
            recoded: None,
        }
    }

    /// Reads the next line of data; false at the end of the file.
    pub(super) fn advance(&mut self) -> Result<bool, ReadError> {
        while self.read_line()? {
            let line = self.line.trim_ascii();
            if !line.is_empty() && line[0] != b'#' {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The line read last, without its end.
    pub(super) fn bytes(&self) -> &[u8] {
        &self.line
    }

    /// Whether the line read last has an end: the last line of a file that was cut short has none.
    pub(super) fn ended(&self) -> bool {
        self.ended
    }

    /// The first line that was read as Windows-1252, since it is no UTF-8.
    pub(super) fn recoded(&self) -> Option<u64> {
        self.recoded
    }

    /// Number of the line read last, from one.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    fn read_line(&mut self) -> Result<bool, ReadError> {
        self.line.clear();
        self.number += 1;
        let mut bounded = self.reader.by_ref().take(MAX_LINE_BYTES as u64 + 1);
        let read = bounded.read_until(b'\n', &mut self.line);
        if let Err(error) = read {
            return Err(ReadError::new(
                Place::file(self.source),
                ReadFault::Io(error),
            ));
        }
        if self.line.len() > MAX_LINE_BYTES {
            return Err(self.error(ReadFault::LineTooLong {
                limit: MAX_LINE_BYTES,
            }));
        }
        if self.line.is_empty() {
            return Ok(false);
        }
        self.strip()?;
        Ok(true)
    }

    /// Removes the line's end and the byte order mark that Windows programs put first.
    fn strip(&mut self) -> Result<(), ReadError> {
        self.ended = self.line.last() == Some(&b'\n');
        if self.ended {
            self.line.pop();
        }
        while self.line.last() == Some(&b'\r') {
            self.line.pop();
        }
        if self.number == 1 && self.line.starts_with(b"\xef\xbb\xbf") {
            self.line.drain(..3);
        }
        if let Some(text) = recoded(&self.line) {
            self.recoded.get_or_insert(self.number);
            self.line = text.into_bytes();
        }
        if self.line.contains(&b'\r') {
            return Err(self.error(ReadFault::CarriageReturn));
        }
        Ok(())
    }

    fn error(&self, fault: ReadFault) -> ReadError {
        ReadError::new(Place::line(self.source, self.number), fault)
    }
}

/// The text of bytes that are no UTF-8 but may be what Excel and LabVIEW write in Europe: bytes that are printed, with one above ASCII.
pub(super) fn recoded(bytes: &[u8]) -> Option<String> {
    // ASCII is by far the usual case.
    if bytes.is_ascii() || std::str::from_utf8(bytes).is_ok() {
        return None;
    }
    let printed = |byte: &u8| *byte >= b' ' && *byte != 0x7f || b"\t\r\n".contains(byte);
    if !bytes.iter().all(printed) {
        return None;
    }
    let (text, _, faulty) = WINDOWS_1252.decode(bytes);
    let ascii = bytes.iter().filter(|byte| byte.is_ascii()).count();
    (!faulty && 2 * ascii >= bytes.len()).then(|| text.into_owned())
}
