//! Rows of a text: their times and their cells.

use std::cell::RefCell;

use super::cell::{is_told, number, switch};
use super::cells::Cells;
use super::clock::Clock;
use super::direction::DirectionWords;
use super::layout::{Column, Layout};
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::scale::Scale;

/// What every row of one file is read with.
pub(super) struct RowReader<'f> {
    pub(super) source: &'f str,
    pub(super) layout: &'f Layout,
    pub(super) rate_hz: Option<f64>,
    pub(super) clock: Clock,
    /// Samples read: their times where the log has none.
    pub(super) taken: u64,
    pub(super) words: RefCell<DirectionWords>,
}

impl RowReader<'_> {
    /// The time of the row just split, which stood on `line`, s; none of a row that is not among those selected, or that tells none.
    pub(super) fn time(
        &mut self,
        row: &Row,
        line: u64,
        scale: &Scale<'_>,
    ) -> Result<Option<f64>, ReadError> {
        let (layout, source) = (self.layout, self.source);
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
                let read = |text: &str| {
                    if !is_told(text) {
                        return Ok(None);
                    }
                    let seconds = clock.seconds(text, scale)?;
                    super::cell::finite(seconds, text).map(Some)
                };
                let read = row.cell(column.index).and_then(read);
                read.map_err(|fault| cell_error(source, line, column, fault))?
            }
            None => Some(self.taken as f64 / self.rate_hz.unwrap_or(1.0)),
        };
        self.taken += u64::from(time_s.is_some());
        Ok(time_s)
    }

    /// An error of the time of a row on `line`.
    pub(super) fn time_error(&self, line: u64, fault: ReadFault) -> ReadError {
        match &self.layout.time {
            Some(column) => cell_error(self.source, line, column, fault),
            None => ReadError::new(Place::line(self.source, line), fault),
        }
    }
}

/// The cells of one row.
pub(super) struct TextCells<'r> {
    pub(super) reader: &'r RowReader<'r>,
    pub(super) row: &'r Row,
    pub(super) line: u64,
}

impl TextCells<'_> {
    fn told(&self, column: &Column) -> Result<Option<&str>, ReadFault> {
        let cell = self.row.cell(column.index)?;
        Ok(Some(cell).filter(|text| is_told(text)))
    }
}

impl Cells for TextCells<'_> {
    fn number(&self, column: &Column) -> Result<Option<f64>, ReadFault> {
        self.told(column)?.map(number).transpose()
    }

    fn switch(&self, column: &Column) -> Result<Option<bool>, ReadFault> {
        self.told(column)?.map(switch).transpose()
    }

    fn direction(&self, column: &Column) -> Result<Option<f64>, ReadFault> {
        let sign = |text: &str| match text.parse::<f64>() {
            Ok(_) => number(text),
            Err(_) => self.reader.words.borrow_mut().sign(text),
        };
        self.told(column)?.map(sign).transpose()
    }

    fn error(&self, column: Option<&Column>, fault: ReadFault) -> ReadError {
        let (source, line) = (self.reader.source, self.line);
        match column {
            Some(column) => cell_error(source, line, column, fault),
            None => ReadError::new(Place::line(source, line), fault),
        }
    }
}

fn cell_error(source: &str, line: u64, column: &Column, fault: ReadFault) -> ReadError {
    ReadError::new(Place::cell(source, line, &column.cell), fault)
}
