//! One line of CSV, split into trimmed cells by the parser of the `csv` crate.
//!
//! A row is one line: a quote may hold separators, but no line end, so that an open quote cannot swallow
//! the rest of the file.

use csv_core::{ReadRecordResult, Reader, ReaderBuilder};

use super::dialect::{Dialect, Names};
use super::keyed;
use super::read_error::ReadFault;

/// The cells of one row; the buffers are kept from row to row.
pub(super) struct Row {
    dialect: Dialect,
    parser: Reader,
    text: Vec<u8>,
    ends: Vec<usize>,
    cells: usize,
}

impl Row {
    /// A splitter for rows of a dialect.
    pub(super) fn new(dialect: &Dialect) -> Self {
        Row {
            dialect: dialect.clone(),
            parser: ReaderBuilder::new().delimiter(dialect.separator).build(),
            text: Vec::new(),
            ends: Vec::new(),
            cells: 0,
        }
    }

    /// The byte that separates the cells.
    pub(super) fn separator(&self) -> u8 {
        self.dialect.separator
    }

    /// Says whether every row stands in quotes as a whole. The parser stays: to make one takes as long as to split a hundred rows, and a clone of
    /// one (csv-core 0.1.13) has lost its classes of bytes.
    pub(super) fn set_quoted_rows(&mut self, quoted_rows: bool) {
        self.dialect.quoted_rows = quoted_rows;
    }

    /// Splits a line without its end.
    pub(super) fn split(&mut self, line: &[u8]) -> Result<(), ReadFault> {
        // No line has more text than bytes, nor more cells than bytes and one.
        let room = line.len() + 2;
        if self.text.len() < room {
            self.text.resize(room, 0);
            self.ends.resize(room, 0);
        }
        if let Names::Keys(keys) = &self.dialect.names {
            let keys = keys.len();
            return self.take_pairs(line, keys);
        }
        let line = self.unquoted(line);
        if self.dialect.separator == b' ' {
            self.cells = 0;
            let words = line.split(u8::is_ascii_whitespace);
            self.take(words.filter(|word| !word.is_empty()));
        } else {
            self.split_csv(line)?;
        }
        if self.dialect.decimal_comma {
            let mut start = 0;
            for end in &self.ends[..self.cells] {
                let cell = &mut self.text[start..*end];
                start = *end;
                // Names and texts keep their commas.
                if cell
                    .iter()
                    .all(|byte| byte.is_ascii_digit() || b" +-.,eE".contains(byte))
                {
                    let commas = cell.iter_mut().filter(|byte| **byte == b',');
                    commas.for_each(|byte| *byte = b'.');
                }
            }
        }
        Ok(())
    }

    fn split_csv(&mut self, line: &[u8]) -> Result<(), ReadFault> {
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

    /// The numbers of a row with names. A row with other names has another number of cells.
    fn take_pairs(&mut self, line: &[u8], keys: usize) -> Result<(), ReadFault> {
        let pairs = keyed::pairs(line).unwrap_or_default();
        let Names::Keys(names) = &self.dialect.names else {
            return Ok(());
        };
        let same = pairs.len() == keys && pairs.iter().zip(names).all(|((a, _), b)| a == b);
        if !same {
            return Err(ReadFault::OtherKeys);
        }
        self.take(pairs.iter().map(|(_, number)| number.as_bytes()));
        Ok(())
    }

    fn take<'l>(&mut self, cells: impl Iterator<Item = &'l [u8]>) {
        let mut end = 0;
        self.cells = 0;
        for cell in cells {
            self.text[end..end + cell.len()].copy_from_slice(cell);
            end += cell.len();
            self.ends[self.cells] = end;
            self.cells += 1;
        }
    }

    /// A row without the quotes that stand about it as a whole.
    fn unquoted<'l>(&self, line: &'l [u8]) -> &'l [u8] {
        if !self.dialect.quoted_rows {
            return line;
        }
        let inner = line.trim_ascii().strip_prefix(b"\"");
        inner
            .and_then(|rest| rest.strip_suffix(b"\""))
            .unwrap_or(line)
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
