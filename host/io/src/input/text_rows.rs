//! The rows of a table in a text.

use std::io::{BufRead, Chain, Cursor, Read};

use super::cell::is_told;
use super::dialect::{Dialect, HEAD_BYTES, Names, data_lines};
use super::layout::{Layout, header_names};
use super::lines::{Lines, recoded};
use super::motor_file::MotorFile;
use super::place::Place;
use super::profile::Profile;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::turns::several;
use super::units_told::with_units;

/// Lines of text among the rows: so many, or one in so many rows.
const MOST_TEXTS: (u64, u64) = (20, 20);

/// The rows of a table in a text.
pub(super) struct TextRows<'s, R> {
    pub(super) lines: Lines<'s, Chain<Cursor<Vec<u8>>, R>>,
    pub(super) row: Row,
    source: &'s str,
    dialect: Dialect,
    pub(super) names: Vec<String>,
    /// The line of the names.
    pub(super) line: u64,
    /// Whether the line at hand is a row that is still to be read: where no row has names the first one is a sample.
    at_row: bool,
    notes: Vec<String>,
    /// Rows so far, and the lines of text among them.
    rows: u64,
    texts: Vec<u64>,
    /// The first bytes of the file.
    head: Vec<u8>,
}

impl<'s, R: BufRead> TextRows<'s, R> {
    /// Finds the table. One without names is refused, unless `motor` names columns by their numbers or `any_names` will do.
    pub(super) fn new(
        mut reader: R,
        source: &'s str,
        motor: &MotorFile,
        any_names: bool,
    ) -> Result<Self, ReadError> {
        let whole = |fault| ReadError::new(Place::file(source), fault);
        let mut head = Vec::new();
        let taken = reader
            .by_ref()
            .take(HEAD_BYTES as u64)
            .read_to_end(&mut head);
        taken.map_err(|error| whole(ReadFault::Io(error)))?;
        let dialect = Dialect::of(&head);
        let mut rows = TextRows {
            lines: Lines::new(Cursor::new(head.clone()).chain(reader), source),
            row: Row::new(&dialect),
            source,
            names: Vec::new(),
            line: 0,
            at_row: dialect.names != Names::Row,
            notes: Vec::new(),
            rows: 0,
            texts: Vec::new(),
            head,
            dialect,
        };
        rows.read_names(any_names || motor.columns.any_number())?;
        Ok(rows)
    }

    pub(super) fn next_line(&mut self) -> Result<bool, ReadError> {
        if std::mem::take(&mut self.at_row) {
            return Ok(true);
        }
        self.lines.advance()
    }

    fn split(&mut self) -> Result<(), ReadError> {
        let line = self.lines.number();
        let split = self.row.split(self.lines.bytes());
        split.map_err(|fault| ReadError::new(Place::line(self.source, line), fault))
    }

    /// Splits the line at hand into as many cells as there are names; false where it is no row but a text, as what a device answers to a
    /// command in the middle of its log.
    pub(super) fn split_row(&mut self) -> Result<bool, ReadError> {
        let split = self.split();
        let (cells, header) = (self.row.len(), self.names.len());
        let is_row = split.is_ok() && self.has_width() && !self.is_text_of_a_rows_width();
        if is_row && !self.repeats_names() {
            self.rows += 1;
            return Ok(true);
        }
        if self.is_text(split.is_ok()) {
            let line = self.lines.number();
            self.texts.push(line);
            if self.texts.len() as u64 <= MOST_TEXTS.0 + self.rows / MOST_TEXTS.1 {
                return Ok(false);
            }
        }
        split?;
        let fault = ReadFault::Ragged { cells, header };
        let place = Place::line(self.source, self.lines.number());
        Err(ReadError::new(place, fault))
    }

    /// Whether the row has a cell for each name, and what stands behind is empty.
    fn has_width(&self) -> bool {
        let behind = self.names.len()..self.row.len();
        self.row.len() >= self.names.len() && { behind }
            .all(|k| self.row.cell(k).is_ok_and(str::is_empty))
    }

    /// Whether the row holds the names once more, as in logs that were put together.
    fn repeats_names(&self) -> bool {
        let cells = (0..self.names.len()).map(|k| self.row.cell(k).ok());
        self.dialect.names == Names::Row
            && cells
                .zip(&self.names)
                .all(|(cell, name)| cell.is_some_and(|cell| cell == name))
    }

    /// Whether the line at hand is a text and no row with a fault: it has other cells, and begins with no number.
    fn is_text(&self, was_split: bool) -> bool {
        let is_keyed = matches!(self.dialect.names, Names::Keys(_));
        let width = self.row.len().max(self.names.len()).max(2);
        self.begins_with_a_word() && (is_keyed || !was_split || 2 * self.numbers() < width)
    }

    /// Whether the line at hand is a text although it has as many cells as a row: it begins with a word, and every cell says something that is
    /// no number.
    fn is_text_of_a_rows_width(&self) -> bool {
        let says = |k: usize| self.row.cell(k).is_ok_and(is_told);
        self.begins_with_a_word()
            && self.numbers() == 0
            && self.names.len() > 1
            && (0..self.names.len()).all(says)
    }

    fn begins_with_a_word(&self) -> bool {
        let line = self.lines.bytes().trim_ascii();
        line.first().is_some_and(|byte| {
            let of_number = byte.is_ascii_digit() || b"+-.,;\t\"".contains(byte);
            !of_number && !byte.is_ascii_control()
        })
    }

    /// Cells of the line at hand that are numbers.
    fn numbers(&self) -> usize {
        let numbers = (0..self.row.len()).filter(|k| {
            let cell = self.row.cell(*k);
            cell.is_ok_and(|cell| cell.parse::<f64>().is_ok_and(f64::is_finite))
        });
        numbers.count()
    }

    fn read_names(&mut self, any_names: bool) -> Result<(), ReadError> {
        for _ in 0..=self.dialect.before {
            if !self.lines.advance()? {
                return Err(ReadError::new(Place::file(self.source), ReadFault::Empty));
            }
        }
        self.line = self.lines.number();
        let line = self.line;
        if self.dialect.before > 0 {
            self.notes.push(format!(
                "{}: the table begins in line {line}; the {} before it are skipped",
                self.source,
                lines(self.dialect.before as u64)
            ));
        }
        self.split()?;
        let names = match &self.dialect.names {
            Names::Keys(keys) => Ok(keys.clone()),
            Names::Numbers(count) if any_names => Ok((1..=*count).map(|k| k.to_string()).collect()),
            Names::Row | Names::Numbers(_) => header_names(&self.row),
        };
        let mut names =
            names.map_err(|fault| ReadError::new(Place::line(self.source, line), fault))?;
        while names.len() > 1 && names.last().is_some_and(String::is_empty) && !self.dialect.pairs {
            names.pop();
        }
        self.names = names;
        if self.dialect.units_row && self.lines.advance()? {
            if self.dialect.pairs {
                self.name_pairs();
            } else {
                self.notes.push(format!(
                    "{}: line {} holds no numbers but units",
                    self.source,
                    self.lines.number()
                ));
            }
        }
        Ok(())
    }

    /// Names for columns in pairs of X and Y, where a name stands over each pair: it is that of Y, and X is its time.
    fn name_pairs(&mut self) {
        let base = self.names.clone();
        for (k, name) in self.names.iter_mut().enumerate() {
            let over = base.get(k - k % 2).map_or("", String::as_str);
            *name = match k % 2 {
                1 => over.to_owned(),
                _ => format!("time of {over}"),
            };
        }
        self.notes.push(format!(
            "{}: line {} says that the columns are pairs of X and Y: each name is that of its Y, and X is the time",
            self.source,
            self.lines.number()
        ));
    }

    /// Whether an error is of a last row that was not written to its end; it is left out then.
    pub(super) fn cut_short(&mut self, error: &ReadError) -> bool {
        let unfinished = matches!(
            error.fault,
            ReadFault::Ragged { .. }
                | ReadFault::OpenQuote
                | ReadFault::NotANumber { .. }
                | ReadFault::EmptyCell
                | ReadFault::OtherKeys
        );
        let is_text = |line: &[u8]| {
            std::str::from_utf8(line)
                .is_ok_and(|text| text.chars().all(|c| !c.is_control() || c == '\t'))
        };
        if self.lines.ended() || !unfinished || !is_text(self.lines.bytes()) {
            return false;
        }
        self.notes.push(format!(
            "{}: the last row (line {}) was not written to its end and is left out",
            self.source,
            self.lines.number()
        ));
        true
    }

    /// The motor file with the units that a row of units tells, where the user says no others than the usual ones; none where it tells
    /// nothing new.
    pub(super) fn with_units(&self, layout: &Layout, motor: &MotorFile) -> Option<MotorFile> {
        let units = self.dialect.units(&self.head)?;
        let unit = |column: usize| units.get(column).map(String::as_str);
        let told = with_units(motor, layout, &unit);
        (told != *motor).then_some(told)
    }

    /// Refuses rows of several motors that take turns, unless rows are selected.
    pub(super) fn refuse_several_motors(&self, layout: &Layout) -> Result<(), ReadError> {
        if !layout.select.is_empty() {
            return Ok(());
        }
        match several(&self.head_profiles(), layout.angle.index) {
            None => Ok(()),
            Some(turns) => Err(ReadError::new(
                Place::line(self.source, self.line),
                ReadFault::SeveralMotors {
                    column: turns.column,
                    values: turns.values,
                },
            )),
        }
    }

    /// The columns of the first rows, with their names.
    fn head_profiles(&self) -> Vec<(String, Profile)> {
        let mut columns: Vec<(String, Profile)> = (self.names.iter())
            .map(|name| (name.clone(), Profile::default()))
            .collect();
        let mut row = Row::new(&self.dialect);
        let text = recoded(&self.head);
        let lines = data_lines(text.as_ref().map_or(&self.head, String::as_bytes));
        for line in self.dialect.first_rows(&lines) {
            if row.split(line).is_err() || row.len() < columns.len() {
                continue;
            }
            for (k, (_, profile)) in columns.iter_mut().enumerate() {
                profile.take_text(row.cell(k).unwrap_or_default());
            }
        }
        columns
    }

    /// The unit of each column, where a row of units tells it.
    pub(super) fn units(&self) -> Option<Vec<String>> {
        self.dialect.units(&self.head)
    }

    /// The names of the columns.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// What was passed over.
    pub(super) fn into_notes(mut self) -> Vec<String> {
        if let Some(first) = self.lines.recoded() {
            self.notes.push(format!(
                "{}: line {first} is no UTF-8; it is read as Windows-1252 (Latin-1)",
                self.source
            ));
        }
        if let [first, ..] = self.texts[..] {
            let count = self.texts.len();
            self.notes.push(format!(
                "{}: {} of text among the rows {} skipped, the first in line {first}",
                self.source,
                lines(count as u64),
                if count == 1 { "is" } else { "are" }
            ));
        }
        self.notes
    }

    /// The cells of the next row; none at the end.
    pub(super) fn advance(&mut self) -> Result<Option<Vec<&str>>, ReadError> {
        loop {
            if !self.next_line()? {
                return Ok(None);
            }
            match self.split_row() {
                Ok(true) => break,
                Ok(false) => {}
                // A row with a fault is looked at as far as it goes; who reads it says what is wrong.
                Err(error) if matches!(error.fault, ReadFault::Ragged { .. }) => break,
                Err(error) if self.cut_short(&error) => return Ok(None),
                Err(error) => return Err(error),
            }
        }
        let line = self.lines.number();
        let width = self.row.len().min(self.names.len());
        let cells: Result<Vec<&str>, ReadFault> = (0..width).map(|k| self.row.cell(k)).collect();
        let cells = cells.map_err(|fault| ReadError::new(Place::line(self.source, line), fault));
        cells.map(Some)
    }
}

fn lines(count: u64) -> String {
    match count {
        1 => "1 line".to_owned(),
        count => format!("{count} lines"),
    }
}
