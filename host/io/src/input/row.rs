//! One line of CSV, split into trimmed cells by the parser of the `csv` crate.
//!
//! A row is one line: a quote may hold separators, but no line end, so that an open quote cannot swallow
//! the rest of the file.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};

use super::read_error::ReadFault;

/// The cells of one row; the buffers are kept from row to row.
pub(super) struct Row {
    separator: u8,
    parser: Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
    cells: usize,
}

impl Row {
    /// A splitter at commas, semicolons or tabs: at what the header has most of, outside of quotes.
    pub(super) fn for_header(header: &[u8]) -> Self {
        let mut quoted = false;
        let mut times = [(b',', 0), (b';', 0), (b'\t', 0)];
        for byte in header {
            quoted ^= *byte == b'"';
            for (separator, times) in &mut times {
                *times += usize::from(!quoted && byte == separator);
            }
        }
        // Of equals the last: a comma is part of a number or a text more often than the others are.
        let most = times.into_iter().max_by_key(|(_, times)| *times);
        let separator = most
            .filter(|(_, times)| *times > 0)
            .map_or(b',', |(byte, _)| byte);
        Row {
            separator,
            parser: ReaderBuilder::new().delimiter(separator).build(),
            text: Vec::new(),
            ends: Vec::new(),
            cells: 0,
        }
    }

    /// Splits a line without its end.
    pub(super) fn split(&mut self, line: &[u8]) -> Result<(), ReadFault> {
        // No line has more text than bytes, nor more cells than bytes and one.
        let room = line.len() + 2;
        if self.text.len() < room {
            self.text.resize(room, 0);
            self.ends.resize(room, 0);
        }
        self.parser.reset();
        let (_, _, text, cells) = self
            .parser
            .read_record(line, &mut self.text, &mut self.ends);
        let (end, _, _, last) =
            self.parser
                .read_record(b"\n", &mut self.text[text..], &mut self.ends[cells..]);
        self.cells = cells + last;
        match end {
            ReadRecordResult::Record => Ok(()),
            _ => Err(ReadFault::OpenQuote),
        }
    }

    /// What separates the cells.
    pub(super) fn separator(&self) -> u8 {
        self.separator
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.cells
    }

    /// The cell at `index`, trimmed.
    pub(super) fn cell(&self, index: usize) -> Result<&str, ReadFault> {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        let bytes = &self.text[start..self.ends[index]];
        std::str::from_utf8(bytes)
            .map(str::trim)
            .map_err(|_| ReadFault::NotText)
    }
}
