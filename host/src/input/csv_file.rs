//! A recording from a CSV file, row by row.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::Path;

use super::cell::{finite, number, switch};
use super::counts::{in_counter_range, snap_to_whole};
use super::layout::{Column, Layout};
use super::lines::Lines;
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, CommandUnit};
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use crate::recording::Recording;

/// Most samples of a recording: 4.6 hours at 1 kHz, at most 0.6 GB in memory. Longer files are refused rather
/// than risk the memory of the machine.
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
    let mut samples = Samples::new(&layout, source);
    while lines.advance()? {
        let line = lines.number();
        row.split(lines.bytes()).map_err(|fault| at(line, fault))?;
        samples.push(&row, line, &layout, &scale)?;
    }
    samples.finish(motor, &scale)
}

/// What turns the file's units into ours, checked once.
struct Scale<'m> {
    motor: &'m MotorFile,
    counts_per_rev: f64,
    volts_per_duty: f64,
    angle_per_rev: f64,
}

impl<'m> Scale<'m> {
    fn new(motor: &'m MotorFile) -> Result<Self, ReadFault> {
        let named = || motor.called().to_string();
        let counts_per_rev = positive("counts_per_rev", motor.counts_per_rev)?
            .ok_or_else(|| ReadFault::NoCountsPerRev { motor: named() })?;
        let supply_v = positive("supply_v", motor.supply_v)?;
        let volts_per_duty = match motor.units.voltage {
            CommandUnit::Duty => supply_v.ok_or_else(|| ReadFault::NoSupply { motor: named() })?,
            _ => 1.0,
        };
        let metres_per_rev = positive("metres_per_rev", motor.metres_per_rev)?;
        let metres_per_rev = match motor.units.angle {
            AngleUnit::Metres => {
                metres_per_rev.ok_or_else(|| ReadFault::NoMetresPerRev { motor: named() })?
            }
            _ => 1.0,
        };
        let angle_per_rev = motor
            .units
            .angle
            .per_revolution(counts_per_rev, metres_per_rev);
        Ok(Scale {
            motor,
            counts_per_rev,
            volts_per_duty,
            angle_per_rev,
        })
    }

    fn command(&self, command: f64) -> f64 {
        match self.motor.units.voltage {
            CommandUnit::Volts | CommandUnit::Amperes => command,
            CommandUnit::Milliamperes => command / 1e3,
            CommandUnit::Duty => command * self.volts_per_duty,
        }
    }

    fn counts(&self, angle: f64) -> Result<f64, ReadFault> {
        if self.motor.units.angle != AngleUnit::Counts {
            return in_counter_range(angle / self.angle_per_rev * self.counts_per_rev);
        }
        if angle.fract() != 0.0 {
            return Err(ReadFault::FractionalCounts {
                counts: angle,
                motor: self.motor.called().into(),
            });
        }
        in_counter_range(angle)
    }
}

/// The motor file's own reader refuses such numbers, but a flag may have set one.
fn positive(key: &'static str, value: Option<f64>) -> Result<Option<f64>, ReadFault> {
    match value {
        Some(value) if !(value.is_finite() && value > 0.0) => {
            Err(ReadFault::NotPositive { key, value })
        }
        value => Ok(value),
    }
}

/// The columns as they grow.
struct Samples<'s> {
    source: &'s str,
    time_s: Vec<f64>,
    command: Vec<f64>,
    counts: Vec<f64>,
    current_a: Option<Vec<f64>>,
    enabled: Option<Vec<bool>>,
}

impl<'s> Samples<'s> {
    fn new(layout: &Layout, source: &'s str) -> Self {
        Samples {
            source,
            time_s: Vec::new(),
            command: Vec::new(),
            counts: Vec::new(),
            current_a: layout.current.as_ref().map(|_| Vec::new()),
            enabled: layout.enabled.as_ref().map(|_| Vec::new()),
        }
    }

    fn push(
        &mut self,
        row: &Row,
        line: u64,
        layout: &Layout,
        scale: &Scale<'_>,
    ) -> Result<(), ReadError> {
        let at_line = |fault| ReadError::new(Place::line(self.source, line), fault);
        if row.len() != layout.width {
            return Err(at_line(ReadFault::Ragged {
                cells: row.len(),
                header: layout.width,
            }));
        }
        if self.time_s.len() == MAX_ROWS {
            return Err(at_line(ReadFault::TooManyRows { limit: MAX_ROWS }));
        }
        let source = self.source;
        let at =
            |column: &Column, fault| ReadError::new(Place::cell(source, line, &column.cell), fault);
        let read = |column: &Column, convert: &dyn Fn(f64) -> Result<f64, ReadFault>| {
            let text = row.cell(column.index).map_err(|fault| at(column, fault))?;
            let value = number(text)
                .and_then(convert)
                .and_then(|value| finite(value, text));
            value.map_err(|fault| at(column, fault))
        };
        let units = &scale.motor.units;
        let time = read(&layout.time, &|time| Ok(units.time.seconds(time)))?;
        increases(self.time_s.last().copied(), time).map_err(|fault| at(&layout.time, fault))?;
        let command = read(&layout.command, &|command| Ok(scale.command(command)))?;
        let counts = read(&layout.angle, &|angle| scale.counts(angle))?;
        let full = |_| at_line(ReadFault::OutOfMemory);
        if let (Some(column), Some(values)) = (&layout.current, &mut self.current_a) {
            let current = read(column, &|current| Ok(units.current.amperes(current)))?;
            append(values, current).map_err(full)?;
        }
        if let (Some(column), Some(values)) = (&layout.enabled, &mut self.enabled) {
            let text = row.cell(column.index).map_err(|fault| at(column, fault))?;
            append(values, switch(text).map_err(|fault| at(column, fault))?).map_err(full)?;
        }
        append(&mut self.time_s, time).map_err(full)?;
        append(&mut self.command, command).map_err(full)?;
        append(&mut self.counts, counts).map_err(full)
    }

    fn finish(mut self, motor: &MotorFile, scale: &Scale<'_>) -> Result<Recording, ReadError> {
        if self.time_s.len() < 2 {
            let fault = ReadFault::TooFewSamples(self.time_s.len());
            return Err(ReadError::new(Place::file(self.source), fault));
        }
        let quantised = motor.units.angle == AngleUnit::Counts || snap_to_whole(&mut self.counts);
        Ok(Recording {
            source: self.source.into(),
            time_s: self.time_s,
            command: self.command,
            counts: self.counts,
            current_a: self.current_a,
            enabled: self.enabled,
            counts_per_rev: scale.counts_per_rev,
            quantised,
            supply_v: motor.supply_v,
            drive: motor.drive,
        })
    }
}

fn increases(before: Option<f64>, now: f64) -> Result<(), ReadFault> {
    match before {
        Some(before) if now < before => Err(ReadFault::TimeBack { before, now }),
        Some(before) if now == before => Err(ReadFault::TimeRepeats { now }),
        _ => Ok(()),
    }
}

/// Pushes where memory allows it; a plain push would abort the program.
fn append<T>(values: &mut Vec<T>, value: T) -> Result<(), std::collections::TryReserveError> {
    if values.len() == values.capacity() {
        values.try_reserve(1)?;
    }
    values.push(value);
    Ok(())
}
