//! A file of any format that is read, opened by its content.

use super::csv_file::{How, read_text};
use super::missing::Advice;
use super::motor_file::MotorFile;
use super::part::Part;
use super::place::Place;
use super::profile::KEPT;
use super::reached::{Count, CountedFile, Reached};
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::survey::survey;
use crate::recording::Recording;
use encoding_rs_io::DecodeReaderBytesBuilder;
#[cfg(feature = "formats")]
use servoid_formats::Log;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

/// Reads all recordings of a file with what `motor` knows about its columns, units and encoder: of a text with columns, compressed
/// or not, or with the feature `formats` of a log that has its own format. `FILE#PART` means one of several recordings.
///
/// # Errors
/// The first fault found, with its place and the remedy: see [`ReadFault`].
pub fn read_recordings(path: &Path, motor: &MotorFile) -> Result<Reading, ReadError> {
    read_recordings_with(path, motor, &|_| ())
}

/// As [`read_recordings`]; `done` is told how far the file was read.
///
/// # Errors
/// As [`read_recordings`].
pub fn read_recordings_with(
    path: &Path,
    motor: &MotorFile,
    done: &dyn Fn(Reached),
) -> Result<Reading, ReadError> {
    read(path, motor, true, done)
}

/// Reads a file as it is said to be; where columns that are needed are not said, as it is proposed, if that is sure.
fn read(
    path: &Path,
    motor: &MotorFile,
    lenient: bool,
    done: &dyn Fn(Reached),
) -> Result<Reading, ReadError> {
    let mut error = match as_said(path, motor, lenient, done) {
        Ok(mut reading) => {
            reading.motor = motor.clone();
            return Ok(reading);
        }
        Err(error) => error,
    };
    let ReadFault::MissingColumns {
        missing, advice, ..
    } = &mut error.fault
    else {
        return Err(error);
    };
    if missing.iter().any(|column| column.mapped) {
        return Err(error);
    }
    let Ok(survey) = survey(path, motor, Some(KEPT as u64), &|_| ()) else {
        return Err(error);
    };
    let proposal = survey.proposal;
    if !proposal.is_sure() {
        if !proposal.columns.is_empty() {
            *advice = Some(Box::new(Advice::of(&proposal)));
        }
        return Err(error);
    }
    let mut reading = as_said(path, &proposal.motor, lenient, done)?;
    let source = Part::of(path).path.display().to_string();
    reading
        .notes
        .insert(0, format!("{source}: read {}", proposal.taken()));
    reading.motor = proposal.motor;
    Ok(reading)
}

/// As [`read_recordings`], of which nothing is guessed: columns that are not said are refused.
///
/// # Errors
/// As [`read_recordings`].
pub fn read_as_said(
    path: &Path,
    motor: &MotorFile,
    done: &dyn Fn(Reached),
) -> Result<Reading, ReadError> {
    let mut reading = as_said(path, motor, true, done)?;
    reading.motor = motor.clone();
    Ok(reading)
}

fn as_said(
    path: &Path,
    motor: &MotorFile,
    lenient: bool,
    done: &dyn Fn(Reached),
) -> Result<Reading, ReadError> {
    let part = Part::of(path);
    let source = part.path.display().to_string();
    let whole = |fault| ReadError::new(Place::file(&source), fault);
    #[cfg(feature = "formats")]
    if let Some(mut log) = log_of(&part.path, &source)? {
        let name = part.name.as_deref();
        return super::log_file::read_log(log.as_mut(), &source, name, motor, done);
    }
    if part.path.is_dir() {
        return Err(whole(ReadFault::Folder));
    }
    let (text, count) = text_of(&part.path).map_err(|error| whole(ReadFault::Io(error)))?;
    let how = How {
        several: true,
        lenient,
    };
    let reading = read_text(text, &source, motor, how, &|rows| {
        done(count.reached(rows));
    })?;
    reading.part(&source, part.name.as_deref()).map_err(whole)
}

/// Reads the only recording of a file.
///
/// # Errors
/// As [`read_recordings`]; the file holds several.
pub fn read_recording(path: &Path, motor: &MotorFile) -> Result<Recording, ReadError> {
    let recording = read_one(path, motor)?.recordings.pop();
    let source = || Part::of(path).path.display().to_string();
    recording.ok_or_else(|| ReadError::new(Place::file(&source()), ReadFault::TooFewSamples(0)))
}

/// The same with what the reader has to say. A last row that was cut off is an error here.
///
/// # Errors
/// As [`read_recording`].
pub fn read_one(path: &Path, motor: &MotorFile) -> Result<Reading, ReadError> {
    let source = Part::of(path).path.display().to_string();
    let reading = read(path, motor, false, &|_| ())?.only(&source);
    reading.map_err(|fault| ReadError::new(Place::file(&source), fault))
}

/// A log of another format than text; `None` where it may be a text.
#[cfg(feature = "formats")]
pub(super) fn log_of(path: &Path, source: &str) -> Result<Option<Box<dyn Log>>, ReadError> {
    servoid_formats::open(path).map_err(|error| super::log_file::of_format(source, error))
}

/// The text of a file in UTF-8, decompressed, and the count of the bytes of the file; UTF-16 is told by its byte order mark.
pub(super) fn text_of(path: &Path) -> io::Result<(Box<dyn BufRead>, Count)> {
    let (file, count) = CountedFile::open(path)?;
    #[cfg(feature = "formats")]
    let bytes = servoid_formats::decompressed_from(file)?;
    #[cfg(not(feature = "formats"))]
    let bytes = BufReader::with_capacity(1 << 16, file);
    let decoded = DecodeReaderBytesBuilder::new()
        .utf8_passthru(true)
        .build(bytes);
    Ok((Box::new(BufReader::with_capacity(1 << 16, decoded)), count))
}
