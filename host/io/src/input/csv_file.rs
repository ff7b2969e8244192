//! Recordings from a text file with columns, row by row.

use std::io::{BufRead, Chain, Cursor, Read};

use super::clock::Clock;
use super::collector::Collector;
use super::dialect::{Dialect, HEAD_BYTES, Names};
use super::layout::{Layout, header_names};
use super::lines::Lines;
use super::motor_file::MotorFile;
use super::place::Place;
use super::reached::ROWS_TO_TELL;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::row::Row;
use super::sample::SampleReader;
use super::scale::Scale;
use crate::recording::Recording;

/// Most samples of a recording: 4.6 hours at 1 kHz, at most 0.6 GB in memory. Longer files are refused
/// rather than risk the memory of the machine.
pub const MAX_ROWS: usize = 1 << 24;

/// Reads the only recording from any reader; `source` names it in errors. Memory is bounded by [`MAX_ROWS`] and
/// [`MAX_LINE_BYTES`](super::MAX_LINE_BYTES).
///
/// # Errors
/// The first fault found, as `file:line:cell: column` with the remedy: see [`ReadFault`].
pub fn read_recording_from(
    reader: impl BufRead,
    source: &str,
    motor: &MotorFile,
) -> Result<Recording, ReadError> {
    let how = How {
        several: false,
        lenient: false,
    };
    let mut reading = read_text(reader, source, motor, how, &|_| ())?;
    let few = || ReadError::new(Place::file(source), ReadFault::TooFewSamples(0));
    reading.recordings.pop().ok_or_else(few)
}

/// How a text is read.
#[derive(Clone, Copy)]
pub(super) struct How {
    /// Whether it may hold several recordings: a new one begins where the clock does.
    pub(super) several: bool,
    /// Whether a last row that was not written to its end is left out, with a note, in place of an error.
    pub(super) lenient: bool,
}

/// Reads all recordings of a text with columns. `done` is told of the rows so far.
pub(super) fn read_text(
    reader: impl BufRead,
    source: &str,
    motor: &MotorFile,
    how: How,
    done: &dyn Fn(u64),
) -> Result<Reading, ReadError> {
    let whole = |fault| ReadError::new(Place::file(source), fault);
    let mut rows = TextRows::new(reader, source, motor, false)?;
    let layout = Layout::find(rows.names.clone(), source, Some(rows.line), motor)?;
    let scale = Scale::new(motor).map_err(whole)?;
    let mut reader = SampleReader {
        source,
        layout: &layout,
        scale: &scale,
        rate_hz: motor.log.rate_hz,
        clock: Clock::default(),
        taken: 0,
    };
    let mut collector = Collector::new(motor, &scale, how.several, layout.further());
    let mut passed: u64 = 0;
    while !collector.has_all() && rows.next_line()? {
        passed += 1;
        if passed.is_multiple_of(ROWS_TO_TELL) {
            done(passed);
        }
        let line = rows.lines.number();
        let mut read = || {
            rows.split()?;
            let Some(time_s) = reader.time(&rows.row, line)? else {
                return Ok(());
            };
            let timed = collector.time(time_s);
            timed.map_err(|fault| reader.time_error(line, fault))?;
            if !collector.wants(time_s) {
                return Ok(());
            }
            let kept = collector.take(&reader.sample(&rows.row, line, time_s)?);
            kept.map_err(|fault| ReadError::new(Place::line(source, line), fault))
        };
        match read() {
            Ok(()) => {}
            Err(error) if how.lenient && rows.cut_short(&error) => break,
            Err(error) => return Err(error),
        }
    }
    motor.log.check_met(reader.taken).map_err(whole)?;
    let recordings = collector.finish(source)?;
    Ok(Reading {
        recordings,
        notes: rows.notes,
    })
}

/// The rows of a table in a text.
pub(super) struct TextRows<'s, R> {
    lines: Lines<'s, Chain<Cursor<Vec<u8>>, R>>,
    row: Row,
    source: &'s str,
    names: Vec<String>,
    /// The line of the names.
    line: u64,
    /// Whether the line at hand is a row that is still to be read: where no row has names the first one is a sample.
    at_row: bool,
    notes: Vec<String>,
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
            lines: Lines::new(Cursor::new(head).chain(reader), source),
            row: Row::new(&dialect),
            source,
            names: Vec::new(),
            line: 0,
            at_row: dialect.names != Names::Row,
            notes: Vec::new(),
        };
        let any_names = any_names || motor.columns.any_number();
        rows.read_names(&dialect, any_names)?;
        Ok(rows)
    }

    fn next_line(&mut self) -> Result<bool, ReadError> {
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

    fn read_names(&mut self, dialect: &Dialect, any_names: bool) -> Result<(), ReadError> {
        for _ in 0..=dialect.before {
            if !self.lines.advance()? {
                return Err(ReadError::new(Place::file(self.source), ReadFault::Empty));
            }
        }
        self.line = self.lines.number();
        let line = self.line;
        if dialect.before > 0 {
            self.notes.push(format!(
                "{}: the table begins in line {line}; what stands before it is passed over",
                self.source
            ));
        }
        self.split()?;
        let names = match &dialect.names {
            Names::Keys(keys) => Ok(keys.clone()),
            Names::Numbers(count) if any_names => Ok((1..=*count).map(|k| k.to_string()).collect()),
            Names::Row | Names::Numbers(_) => header_names(&self.row),
        };
        self.names =
            names.map_err(|fault| ReadError::new(Place::line(self.source, line), fault))?;
        if dialect.units_row && self.lines.advance()? {
            self.notes.push(format!(
                "{}: line {} holds no numbers (units, it seems) and is passed over",
                self.source,
                self.lines.number()
            ));
        }
        Ok(())
    }

    /// Whether an error is of a last row that was not written to its end; it is left out then.
    fn cut_short(&mut self, error: &ReadError) -> bool {
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

    /// The names of the columns.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// What was passed over.
    pub(super) fn notes(self) -> Vec<String> {
        self.notes
    }

    /// The cells of the next row; none at the end.
    pub(super) fn advance(&mut self) -> Result<Option<Vec<&str>>, ReadError> {
        if !self.next_line()? {
            return Ok(None);
        }
        if let Err(error) = self.split() {
            return if self.cut_short(&error) {
                Ok(None)
            } else {
                Err(error)
            };
        }
        let line = self.lines.number();
        let cells: Result<Vec<&str>, ReadFault> =
            (0..self.row.len()).map(|k| self.row.cell(k)).collect();
        let cells = cells.map_err(|fault| ReadError::new(Place::line(self.source, line), fault));
        cells.map(Some)
    }
}
