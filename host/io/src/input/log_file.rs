//! Recordings from logs of other formats, whose tables have names, kinds and units of their own.

use super::cell::checked;
use super::cells::{Cells, Sample};
use super::collector::Collector;
use super::layout::{Column, Layout};
use super::log_table::{self, Joined};
use super::motor_file::MotorFile;
use super::place::Place;
use super::reached::Reached;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::scale::Scale;
use super::units_told::with_units;
use crate::channel::Channel;
use servoid_formats::{FormatError, Kind, Log, Rows, Table};
use std::ops::ControlFlow;

/// Reads the recordings of a log: one of every table that has all columns, or one from columns of several tables. `done` is told how
/// far.
pub(super) fn read_log(
    log: &mut dyn Log,
    source: &str,
    part: Option<&str>,
    motor: &MotorFile,
    done: &dyn Fn(Reached),
) -> Result<Reading, ReadError> {
    let whole = |fault| ReadError::new(Place::file(source), fault);
    let tables = log.tables().to_vec();
    let wanted = part.or(motor.log.table.as_deref());
    let named = |table: &Table| wanted.is_none_or(|name| table.name == name);
    let mut chosen: Vec<usize> = (0..tables.len()).filter(|k| named(&tables[*k])).collect();
    if chosen.is_empty() {
        if motor.log.table.is_some() {
            let known = log_table::names(&tables);
            let part = wanted.unwrap_or_default().to_owned();
            return Err(whole(ReadFault::NoSuchPart { part, known }));
        }
        chosen = (0..tables.len()).collect();
    }
    if let Some(joined) = Joined::find(&tables, motor) {
        let read = joined.map_err(whole)?.read(log, source, motor, done);
        return read.and_then(|reading| reading.part(source, part).map_err(whole));
    }
    let mut found = Vec::new();
    let mut refused: Option<(usize, ReadError)> = None;
    for index in chosen {
        let table = &tables[index];
        match layout(table, &called(source, table), motor) {
            Ok(layout) => found.push((index, layout)),
            Err(error) => {
                let missing = log_table::missing(&error.fault);
                if refused.as_ref().is_none_or(|(least, _)| missing < *least) {
                    refused = Some((missing, error));
                }
            }
        }
    }
    if found.is_empty() {
        let (_, error) = refused.ok_or_else(|| whole(ReadFault::Empty))?;
        return Err(error);
    }
    let mut reading = Reading::of(Vec::new(), Vec::new());
    let alone = found.len() == 1;
    let all = rows_of(found.iter().map(|(index, _)| &tables[*index]));
    let mut rows = 0;
    for (index, layout) in found {
        let name = if alone && part.is_none() {
            source.to_owned()
        } else {
            called(source, &tables[index])
        };
        let unit = |column: usize| tables[index].columns[column].unit.as_deref();
        let motor = with_units(motor, &layout, &unit);
        let scale = Scale::new(&motor, &layout.further()).map_err(whole)?;
        let read = TableReader {
            log,
            index,
            layout: &layout,
            name: &name,
            motor: &motor,
            scale: &scale,
        };
        let one = read.read(&mut |more| {
            rows += more;
            done(Reached::of(rows, all));
        })?;
        reading.recordings.extend(one.recordings);
        reading.notes.extend(one.notes);
    }
    let by_table = reading.recordings.len() == 1;
    let part = part.filter(|_| !by_table);
    reading.part(source, part).map_err(whole)
}

/// The rows of all these tables, where the file says how many each has.
pub(super) fn rows_of<'t>(tables: impl Iterator<Item = &'t Table>) -> Option<u64> {
    tables.map(|table| table.rows).sum()
}

/// How a table is called in messages, and its recording.
fn called(source: &str, table: &Table) -> String {
    if table.name.is_empty() {
        source.to_owned()
    } else {
        format!("{source}#{}", table.name)
    }
}

/// The columns of a table. A column of times is the time where the user names none.
fn layout(table: &Table, name: &str, motor: &MotorFile) -> Result<Layout, ReadError> {
    let names: Vec<String> = table.columns.iter().map(|c| c.name.clone()).collect();
    let time = table
        .columns
        .iter()
        .find(|column| column.kind == Kind::Time);
    let mut motor = motor.clone();
    let named = motor.columns.get(Channel::Time).is_some();
    if let (Some(column), false, None) = (time, named, motor.log.rate_hz) {
        motor.columns.set(Channel::Time, Some(column.name.clone()));
    }
    Layout::find(names, name, None, &motor)
}

/// Reads one table.
struct TableReader<'r> {
    log: &'r mut dyn Log,
    index: usize,
    layout: &'r Layout,
    name: &'r str,
    motor: &'r MotorFile,
    scale: &'r Scale<'r>,
}

impl TableReader<'_> {
    /// `done` is told of more rows.
    fn read(self, done: &mut dyn FnMut(u64)) -> Result<Reading, ReadError> {
        let TableReader {
            log,
            index,
            layout,
            name,
            motor,
            scale,
        } = self;
        let kinds: Vec<Kind> = log.tables()[index].columns.iter().map(|c| c.kind).collect();
        let asked = Asked::of(layout);
        let mut collector = Collector::new(motor, scale, true, layout.further());
        let (mut row, mut taken, mut without_time) = (0u64, 0u64, 0u64);
        let mut fault = None;
        let mut take = |rows: Rows<'_>| -> Result<bool, ReadError> {
            let samples = rows.first().map_or(0, Vec::len);
            done(samples as u64);
            for k in 0..samples {
                row += 1;
                let cells = LogCells {
                    name,
                    row,
                    asked: &asked,
                    rows,
                    place: k,
                };
                if !cells.selected(layout) {
                    continue;
                }
                let stamp = match &layout.time {
                    Some(column) => cells.time(column, kinds[column.index], scale)?,
                    None => Some(taken as f64 / motor.log.rate_hz.unwrap_or(1.0)),
                };
                let Some(stamp) = stamp else {
                    without_time += 1;
                    continue;
                };
                taken += 1;
                let timed = collector.time(stamp, row);
                let time = timed.map_err(|fault| cells.error(layout.time.as_ref(), fault))?;
                if collector.wants(time) {
                    let kept = collector.take(&Sample::of(&cells, layout, scale, time)?);
                    kept.map_err(|fault| cells.error(None, fault))?;
                }
                if collector.has_all() {
                    return Ok(false);
                }
            }
            Ok(true)
        };
        let read = log.read(index, &asked.columns, &mut |rows| match take(rows) {
            Ok(true) => ControlFlow::Continue(()),
            Ok(false) => ControlFlow::Break(()),
            Err(error) => {
                fault = Some(error);
                ControlFlow::Break(())
            }
        });
        if let Some(error) = fault {
            return Err(error);
        }
        read.map_err(|error| of_format(name, error))?;
        let met = motor.log.check_met(taken);
        met.map_err(|fault| ReadError::new(Place::file(name), fault))?;
        let mut reading = collector.finish(name)?;
        reading.notes.extend((without_time > 0).then(|| {
            format!("{name}: {without_time} of {row} rows have no time and are left out")
        }));
        Ok(reading)
    }
}

/// An error of a format's reader.
pub(super) fn of_format(name: &str, error: FormatError) -> ReadError {
    ReadError::new(
        Place::file(name),
        ReadFault::Log {
            place: error.place,
            fault: error.fault,
        },
    )
}

/// The columns that are read, each once.
struct Asked {
    columns: Vec<usize>,
}

impl Asked {
    fn of(layout: &Layout) -> Self {
        let mut columns: Vec<usize> = layout.columns().map(|column| column.index).collect();
        columns.sort_unstable();
        columns.dedup();
        Asked { columns }
    }

    /// The value of a column in a row.
    fn value(&self, column: &Column, rows: Rows<'_>, k: usize) -> f64 {
        let place = self.columns.binary_search(&column.index);
        place.map_or(f64::NAN, |place| rows[place][k])
    }
}

/// One row.
struct LogCells<'r> {
    name: &'r str,
    /// Its number in the table, from one.
    row: u64,
    asked: &'r Asked,
    rows: Rows<'r>,
    /// Its place among the rows that were handed on.
    place: usize,
}

impl LogCells<'_> {
    fn value(&self, column: &Column) -> f64 {
        self.asked.value(column, self.rows, self.place)
    }

    fn selected(&self, layout: &Layout) -> bool {
        let mut select = layout.select.iter();
        select.all(|(column, selection)| selection.holds(&self.value(column).to_string()))
    }

    /// Seconds: of a column that holds times as the log tells them, else in the motor file's unit.
    fn time(
        &self,
        column: &Column,
        kind: Kind,
        scale: &Scale<'_>,
    ) -> Result<Option<f64>, ReadError> {
        let read = self.number(column);
        let time = read.map_err(|fault| self.error(Some(column), fault))?;
        Ok(time.map(|time| match kind {
            Kind::Time => time,
            _ => scale.time(time),
        }))
    }
}

impl Cells for LogCells<'_> {
    fn number(&self, column: &Column) -> Result<Option<f64>, ReadFault> {
        let told = Some(self.value(column)).filter(|value| !value.is_nan());
        told.map(checked).transpose()
    }

    fn switch(&self, column: &Column) -> Result<Option<bool>, ReadFault> {
        match self.number(column)? {
            None => Ok(None),
            Some(1.0) => Ok(Some(true)),
            Some(0.0) => Ok(Some(false)),
            Some(other) => Err(ReadFault::NotASwitch {
                text: other.to_string(),
            }),
        }
    }

    fn direction(&self, column: &Column) -> Result<Option<f64>, ReadFault> {
        self.number(column)
    }

    fn error(&self, column: Option<&Column>, fault: ReadFault) -> ReadError {
        let place = match column {
            Some(column) => Place::cell(self.name, self.row, &column.cell),
            None => Place::line(self.name, self.row),
        };
        ReadError::new(place, fault)
    }
}
