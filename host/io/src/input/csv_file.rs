//! Recordings from a text file with columns, row by row.

use std::cell::RefCell;
use std::io::BufRead;

use super::cells::Sample;
use super::clock::Clock;
use super::collector::Collector;
use super::layout::Layout;
use super::motor_file::MotorFile;
use super::place::Place;
use super::reached::ROWS_TO_TELL;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::row_reader::{RowReader, TextCells};
use super::scale::Scale;
use super::text_rows::TextRows;
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
    let reading = read_text(reader, source, motor, how, &|_| ())?;
    let whole = |fault| ReadError::new(Place::file(source), fault);
    let mut reading = reading.only(source).map_err(whole)?;
    let few = || whole(ReadFault::TooFewSamples(0));
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
    rows.refuse_several_motors(&layout)?;
    let told = rows.with_units(&layout, motor);
    let motor = told.as_ref().unwrap_or(motor);
    let scale = Scale::new(motor, &layout.further()).map_err(whole)?;
    let mut reader = RowReader {
        source,
        layout: &layout,
        rate_hz: motor.log.rate_hz,
        clock: Clock::default(),
        taken: 0,
        words: RefCell::default(),
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
            if !rows.split_row()? {
                return Ok(());
            }
            let Some(stamp) = reader.time(&rows.row, line, &scale)? else {
                return Ok(());
            };
            let timed = collector.time(stamp, line);
            let time_s = timed.map_err(|fault| reader.time_error(line, fault))?;
            if !collector.wants(time_s) {
                return Ok(());
            }
            let cells = TextCells {
                reader: &reader,
                row: &rows.row,
                line,
            };
            let kept = collector.take(&Sample::of(&cells, &layout, &scale, time_s)?);
            kept.map_err(|fault| ReadError::new(Place::line(source, line), fault))
        };
        match read() {
            Ok(()) => {}
            Err(error) if how.lenient && rows.cut_short(&error) => break,
            Err(error) => return Err(error),
        }
    }
    motor.log.check_met(reader.taken).map_err(whole)?;
    let mut reading = collector.finish(source)?;
    let words = reader.words.into_inner();
    let settled = words.settle(&mut reading.recordings);
    let settled = settled.map(|text| format!("{source}: {text}"));
    reading.notes = [
        rows.into_notes(),
        reading.notes,
        settled.into_iter().collect(),
    ]
    .concat();
    Ok(reading)
}
