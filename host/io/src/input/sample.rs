//! One row of the file to one sample.

use super::cell::{finite, is_told, number, switch};
use super::clock::Clock;
use super::layout::{Column, Layout};
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::scale::Scale;

/// One sample in our units.
pub(super) struct Sample {
    pub(super) time_s: f64,
    pub(super) command: f64,
    pub(super) counts: f64,
    pub(super) current_a: Option<f64>,
    /// None where the row does not tell it.
    pub(super) temperature_c: Option<f64>,
    pub(super) enabled: Option<bool>,
}

/// What every row of one file is read with.
pub(super) struct SampleReader<'f> {
    pub(super) source: &'f str,
    pub(super) layout: &'f Layout,
    pub(super) scale: &'f Scale<'f>,
    pub(super) rate_hz: Option<f64>,
    pub(super) clock: Clock,
    /// Samples read: their times where the log has none.
    pub(super) taken: u64,
}

impl SampleReader<'_> {
    /// The time of the row just split, which stood on `line`, s; none of a row that is not among those selected.
    pub(super) fn time(&mut self, row: &Row, line: u64) -> Result<Option<f64>, ReadError> {
        let (layout, scale, source) = (self.layout, self.scale, self.source);
        if row.len() != layout.width {
            let fault = ReadFault::Ragged {
                cells: row.len(),
                header: layout.width,
            };
            return Err(ReadError::new(Place::line(source, line), fault));
        }
        for (column, selection) in &layout.select {
            let cell = row.cell(column.index);
            let cell = cell.map_err(|fault| cell_error(source, line, column, fault))?;
            if !selection.holds(cell) {
                return Ok(None);
            }
        }
        let time_s = match &layout.time {
            Some(column) => {
                let clock = &mut self.clock;
                let read = |text: &str| finite(clock.seconds(text, scale)?, text);
                let read = row.cell(column.index).and_then(read);
                read.map_err(|fault| cell_error(source, line, column, fault))?
            }
            None => self.taken as f64 / self.rate_hz.unwrap_or(1.0),
        };
        self.taken += 1;
        Ok(Some(time_s))
    }

    /// The sample of the same row, whose time was read.
    pub(super) fn sample(&self, row: &Row, line: u64, time_s: f64) -> Result<Sample, ReadError> {
        let (layout, scale, source) = (self.layout, self.scale, self.source);
        let number = |column: &Column, convert: &dyn Fn(f64) -> Result<f64, ReadFault>| {
            let read = |text: &str| finite(convert(number(text)?)?, text);
            let read = row.cell(column.index).and_then(read);
            read.map_err(|fault| cell_error(source, line, column, fault))
        };
        let direction = layout.direction.as_ref();
        let direction = direction.map(|column| number(column, &Ok)).transpose()?;
        let command = number(&layout.command, &|command| {
            scale.command(directed(command, direction))
        })?;
        let counts = number(&layout.angle, &|angle| scale.counts(angle))?;
        let current = layout.current.as_ref();
        let current_a = current
            .map(|column| number(column, &|x| scale.current(x)))
            .transpose()?;
        let told = |column: &&Column| row.cell(column.index).map_or(true, is_told);
        let temperature = layout.temperature.as_ref().filter(told);
        let temperature_c = temperature
            .map(|column| number(column, &|x| scale.temperature(x)))
            .transpose()?;
        let enabled = layout.enabled.as_ref();
        let enabled = enabled
            .map(|column| {
                let read = row.cell(column.index).and_then(switch);
                read.map_err(|fault| cell_error(source, line, column, fault))
            })
            .transpose()?;
        Ok(Sample {
            time_s,
            command,
            counts,
            current_a,
            temperature_c,
            enabled,
        })
    }

    /// An error of the time of a row on `line`.
    pub(super) fn time_error(&self, line: u64, fault: ReadFault) -> ReadError {
        match &self.layout.time {
            Some(column) => cell_error(self.source, line, column, fault),
            None => ReadError::new(Place::line(self.source, line), fault),
        }
    }
}

pub(super) fn increasing(before: Option<f64>, now: f64) -> Result<f64, ReadFault> {
    match before {
        Some(before) if now < before => Err(ReadFault::TimeBack { before, now }),
        Some(before) if now == before => Err(ReadFault::TimeRepeats { now }),
        _ => Ok(now),
    }
}

/// A command with its direction, where that has a column of its own: backwards is zero, as on the direction pin of a bridge, or
/// negative.
pub(super) fn directed(command: f64, direction: Option<f64>) -> f64 {
    match direction {
        Some(direction) if direction <= 0.0 => 0.0 - command,
        _ => command,
    }
}

fn cell_error(source: &str, line: u64, column: &Column, fault: ReadFault) -> ReadError {
    ReadError::new(Place::cell(source, line, &column.cell), fault)
}
