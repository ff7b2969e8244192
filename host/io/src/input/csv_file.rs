//! A recording from a CSV file, row by row.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::layout::Layout;
use super::lines::Lines;
use super::motor_file::MotorFile;
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::sample::SampleReader;
use super::samples::Samples;
use super::scale::Scale;
use crate::recording::Recording;

/// Most samples of a recording: 4.6 hours at 1 kHz, at most 0.6 GB in memory. Longer files are refused
/// rather than risk the memory of the machine.
pub const MAX_ROWS: usize = 1 << 24;

/// Reads the recording in a CSV file with what `motor` knows about its columns, units and encoder.
///
/// # Errors
/// The first fault found, as `file:line:cell: column` with the remedy: see [`ReadFault`].
pub fn read_recording(path: &Path, motor: &MotorFile) -> Result<Recording, ReadError> {
    let source = path.display().to_string();
    let fail = |fault| ReadError::new(Place::file(&source), fault);
    if path.is_dir() {
        return Err(fail(ReadFault::Folder));
    }
    let file = File::open(path).map_err(|error| fail(ReadFault::Io(error)))?;
    read_recording_from(BufReader::with_capacity(1 << 16, file), &source, motor)
}

/// Reads a recording from any reader; `source` names it in errors. Memory is bounded by [`MAX_ROWS`] and
/// [`MAX_LINE_BYTES`](super::MAX_LINE_BYTES).
///
/// # Errors
/// As [`read_recording`].
pub fn read_recording_from(
    reader: impl BufRead,
    source: &str,
    motor: &MotorFile,
) -> Result<Recording, ReadError> {
    let mut lines = Lines::new(reader, source);
    if !lines.advance()? {
        return Err(ReadError::new(Place::file(source), ReadFault::Empty));
    }
    let at = |line, fault| ReadError::new(Place::line(source, line), fault);
    let mut row = Row::for_header(lines.bytes());
    row.split(lines.bytes())
        .map_err(|fault| at(lines.number(), fault))?;
    let layout = Layout::find(&row, source, lines.number(), motor)?;
    let scale = Scale::new(motor).map_err(|fault| ReadError::new(Place::file(source), fault))?;
    let reader = SampleReader {
        source,
        layout: &layout,
        scale: &scale,
    };
    let mut samples = Samples::new(layout.current.is_some(), layout.enabled.is_some());
    while lines.advance()? {
        let line = lines.number();
        row.split(lines.bytes()).map_err(|fault| at(line, fault))?;
        let sample = reader.read(&row, line, samples.last_time())?;
        samples.push(&sample).map_err(|fault| at(line, fault))?;
    }
    let recording = samples.finish(source, motor, &scale);
    recording.map_err(|fault| ReadError::new(Place::file(source), fault))
}
