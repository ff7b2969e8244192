//! Lines of a text file, one at a time and of bounded length: a file of any size costs one line of memory.

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
}

impl<'s, R: BufRead> Lines<'s, R> {
    pub(super) fn new(reader: R, source: &'s str) -> Self {
        Lines {
            reader,
            source,
            number: 0,
            line: Vec::new(),
            ended: true,
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
        if self.line.contains(&b'\r') {
            return Err(self.error(ReadFault::CarriageReturn));
        }
        Ok(())
    }

    fn error(&self, fault: ReadFault) -> ReadError {
        ReadError::new(Place::line(self.source, self.number), fault)
    }
}
