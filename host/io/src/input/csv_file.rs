//! A recording from a CSV file, row by row.

use std::collections::TryReserveError;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::counts::snap_to_whole;
use super::layout::Layout;
use super::lines::Lines;
use super::motor_file::MotorFile;
use super::motor_units::AngleUnit;
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::sample::{Sample, SampleReader};
use super::scale::{Scale, positive};
use crate::position_loop::{Follower, LoopSettings};
use crate::recording::{PositionDrive, Recording};

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
    let mut samples = Samples::new(&layout);
    while lines.advance()? {
        let line = lines.number();
        row.split(lines.bytes()).map_err(|fault| at(line, fault))?;
        let sample = reader.read(&row, line, samples.time_s.last().copied())?;
        samples.push(&sample).map_err(|fault| at(line, fault))?;
    }
    let recording = samples.finish(source, motor, &scale);
    recording.map_err(|fault| ReadError::new(Place::file(source), fault))
}

/// The columns as they grow.
struct Samples {
    time_s: Vec<f64>,
    command: Vec<f64>,
    counts: Vec<f64>,
    current_a: Option<Vec<f64>>,
    enabled: Option<Vec<bool>>,
}

impl Samples {
    fn new(layout: &Layout) -> Self {
        Samples {
            time_s: Vec::new(),
            command: Vec::new(),
            counts: Vec::new(),
            current_a: layout.current.as_ref().map(|_| Vec::new()),
            enabled: layout.enabled.as_ref().map(|_| Vec::new()),
        }
    }

    fn push(&mut self, sample: &Sample) -> Result<(), ReadFault> {
        if self.time_s.len() == MAX_ROWS {
            return Err(ReadFault::TooManyRows { limit: MAX_ROWS });
        }
        self.try_push(sample).map_err(|_| ReadFault::OutOfMemory)
    }

    fn try_push(&mut self, sample: &Sample) -> Result<(), TryReserveError> {
        append(&mut self.time_s, sample.time_s)?;
        append(&mut self.command, sample.command)?;
        append(&mut self.counts, sample.counts)?;
        if let (Some(values), Some(value)) = (&mut self.current_a, sample.current_a) {
            append(values, value)?;
        }
        if let (Some(values), Some(value)) = (&mut self.enabled, sample.enabled) {
            append(values, value)?;
        }
        Ok(())
    }

    fn finish(
        mut self,
        source: &str,
        motor: &MotorFile,
        scale: &Scale,
    ) -> Result<Recording, ReadFault> {
        if self.time_s.len() < 2 {
            return Err(ReadFault::TooFewSamples(self.time_s.len()));
        }
        let mut position = (motor.position)
            .map(|settings| self.followed(settings, motor, scale))
            .transpose()?;
        let dropped = match motor.units.angle {
            AngleUnit::Counts => Some(0.0),
            _ => snap_to_whole(&mut self.counts),
        };
        let targets = position.iter_mut().flat_map(|p| &mut p.target_counts);
        targets.for_each(|target| *target -= dropped.unwrap_or(0.0));
        Ok(Recording {
            source: source.into(),
            time_s: self.time_s,
            command: self.command,
            counts: self.counts,
            current_a: self.current_a,
            enabled: self.enabled,
            counts_per_rev: scale.counts_per_rev,
            quantised: dropped.is_some(),
            supply_v: motor.supply_v,
            drive: motor.drive,
            position,
        })
    }

    /// Targets become the volts that the loop makes of them. The readings are as they came: the loop knows no other zero.
    fn followed(
        &mut self,
        settings: LoopSettings,
        motor: &MotorFile,
        scale: &Scale,
    ) -> Result<PositionDrive, ReadFault> {
        let called = || motor.called().to_owned();
        let limit = positive("limit_v", settings.limit_v.or(motor.supply_v))?;
        let limit = limit.ok_or_else(|| ReadFault::NoLimit { motor: called() })?;
        let target_counts = std::mem::take(&mut self.command);
        let follower = Follower {
            time_s: &self.time_s,
            target_counts: &target_counts,
            counts: &self.counts,
            enabled: self.enabled.as_deref(),
            counts_per_rev: scale.counts_per_rev,
        };
        let control = follower.control(&settings, limit);
        let control = control.map_err(|why| ReadFault::LoopGain {
            why,
            motor: called(),
        })?;
        self.command = follower.volts(&control);
        Ok(PositionDrive {
            control,
            target_counts,
        })
    }
}

/// Pushes where memory allows it; a plain push would abort the program.
fn append<T>(values: &mut Vec<T>, value: T) -> Result<(), TryReserveError> {
    values.try_reserve(1)?;
    values.push(value);
    Ok(())
}
