//! One row of the file to one sample.

use super::cell::{finite, number, switch};
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
    pub(super) enabled: Option<bool>,
}

/// What every row of one file is read with.
pub(super) struct SampleReader<'f> {
    pub(super) source: &'f str,
    pub(super) layout: &'f Layout,
    pub(super) scale: &'f Scale<'f>,
}

impl SampleReader<'_> {
    /// Reads the row just split, which stood on `line`; `before` is the time of the sample before.
    pub(super) fn read(
        &self,
        row: &Row,
        line: u64,
        before: Option<f64>,
    ) -> Result<Sample, ReadError> {
        let (layout, scale) = (self.layout, self.scale);
        if row.len() != layout.width {
            let fault = ReadFault::Ragged {
                cells: row.len(),
                header: layout.width,
            };
            return Err(ReadError::new(Place::line(self.source, line), fault));
        }
        let cells = Cells {
            reader: self,
            row,
            line,
        };
        let time_s = cells.number(&layout.time, |time| increasing(before, scale.time(time)?))?;
        let command = cells.number(&layout.command, |command| scale.command(command))?;
        let counts = cells.number(&layout.angle, |angle| scale.counts(angle))?;
        let current = layout.current.as_ref();
        let current_a = current
            .map(|column| cells.number(column, |x| scale.current(x)))
            .transpose()?;
        let enabled = layout
            .enabled
            .as_ref()
            .map(|column| cells.switch(column))
            .transpose()?;
        Ok(Sample {
            time_s,
            command,
            counts,
            current_a,
            enabled,
        })
    }
}

/// The cells of one row.
struct Cells<'r> {
    reader: &'r SampleReader<'r>,
    row: &'r Row,
    line: u64,
}

impl Cells<'_> {
    fn number(
        &self,
        column: &Column,
        convert: impl Fn(f64) -> Result<f64, ReadFault>,
    ) -> Result<f64, ReadError> {
        let read = |text: &str| finite(convert(number(text)?)?, text);
        self.row
            .cell(column.index)
            .and_then(read)
            .map_err(|fault| self.error(column, fault))
    }

    fn switch(&self, column: &Column) -> Result<bool, ReadError> {
        self.row
            .cell(column.index)
            .and_then(switch)
            .map_err(|fault| self.error(column, fault))
    }

    fn error(&self, column: &Column, fault: ReadFault) -> ReadError {
        ReadError::new(
            Place::cell(self.reader.source, self.line, &column.cell),
            fault,
        )
    }
}

pub(super) fn increasing(before: Option<f64>, now: f64) -> Result<f64, ReadFault> {
    match before {
        Some(before) if now < before => Err(ReadFault::TimeBack { before, now }),
        Some(before) if now == before => Err(ReadFault::TimeRepeats { now }),
        _ => Ok(now),
    }
}
