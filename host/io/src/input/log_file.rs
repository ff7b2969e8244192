//! Recordings from logs of other formats, whose tables have names, kinds and units of their own.

use super::cell::checked;
use super::collector::Collector;
use super::layout::{Column, Layout};
use super::log_table::{self, Joined};
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, TimeUnit};
use super::place::Place;
use super::preset::Preset;
use super::reached::Reached;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::sample::{Sample, directed};
use super::scale::Scale;
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
        let scale = Scale::new(motor).map_err(whole)?;
        let read = joined
            .map_err(whole)?
            .read(log, source, motor, &scale, done);
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
    let mut reading = Reading {
        recordings: Vec::new(),
        notes: Vec::new(),
    };
    let alone = found.len() == 1;
    let all = rows_of(found.iter().map(|(index, _)| &tables[*index]));
    let mut rows = 0;
    for (index, layout) in found {
        let name = if alone && part.is_none() {
            source.to_owned()
        } else {
            called(source, &tables[index])
        };
        let motor = with_units_of(&tables[index], &layout, motor);
        let scale = Scale::new(&motor).map_err(whole)?;
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
    if let (Some(column), None, None) = (time, &motor.columns.time, motor.log.rate_hz) {
        motor.columns.time = Some(column.name.clone());
    }
    Layout::find(names, name, None, &motor)
}

/// The motor file with the units that the log itself tells, where the user says no others than the usual ones.
fn with_units_of(table: &Table, layout: &Layout, motor: &MotorFile) -> MotorFile {
    let mut motor = motor.clone();
    let usual = motor.log.preset.map(Preset::units).unwrap_or_default();
    let told = |column: &Column| table.columns[column.index].unit.as_deref();
    let angle = told(&layout.angle).and_then(AngleUnit::of_text);
    if let Some(unit) = angle.filter(|_| motor.units.angle == usual.angle) {
        motor.units.angle = unit;
    }
    let time = layout
        .time
        .as_ref()
        .and_then(told)
        .and_then(TimeUnit::of_text);
    if let Some(unit) = time.filter(|_| motor.units.time == usual.time) {
        motor.units.time = unit;
    }
    motor
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
        let (mut row, mut taken, mut left_out) = (0u64, 0u64, 0u64);
        let mut fault = None;
        let mut take = |rows: Rows<'_>| -> Result<bool, ReadError> {
            let samples = rows.first().map_or(0, Vec::len);
            done(samples as u64);
            for k in 0..samples {
                row += 1;
                let cells = Cells {
                    layout,
                    scale,
                    name,
                    row,
                    asked: &asked,
                    rows,
                    place: k,
                };
                if !cells.selected() {
                    continue;
                }
                if cells.incomplete() {
                    left_out += 1;
                    continue;
                }
                let time = match &layout.time {
                    Some(column) => cells.time(column, kinds[column.index])?,
                    None => taken as f64 / motor.log.rate_hz.unwrap_or(1.0),
                };
                taken += 1;
                let timed = collector.time(time);
                timed.map_err(|fault| cells.error(layout.time.as_ref(), fault))?;
                if collector.wants(time) {
                    let kept = collector.take(&cells.sample(time)?);
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
        let recordings = collector.finish(name)?;
        let notes = (left_out > 0).then(|| {
            format!(
                "{name}: {left_out} of {row} rows lack a number that is needed and are left out"
            )
        });
        Ok(Reading {
            recordings,
            notes: notes.into_iter().collect(),
        })
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
        let named = [
            layout.time.as_ref(),
            Some(&layout.command),
            Some(&layout.angle),
            layout.current.as_ref(),
            layout.temperature.as_ref(),
            layout.enabled.as_ref(),
            layout.direction.as_ref(),
        ];
        let selected = layout.select.iter().map(|(column, _)| column);
        let mut columns: Vec<usize> = (named.into_iter().flatten().chain(selected))
            .map(|column| column.index)
            .collect();
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
struct Cells<'r> {
    layout: &'r Layout,
    scale: &'r Scale<'r>,
    name: &'r str,
    /// Its number in the table, from one.
    row: u64,
    asked: &'r Asked,
    rows: Rows<'r>,
    /// Its place among the rows that were handed on.
    place: usize,
}

impl Cells<'_> {
    fn value(&self, column: &Column) -> f64 {
        self.asked.value(column, self.rows, self.place)
    }

    fn selected(&self) -> bool {
        let mut select = self.layout.select.iter();
        select.all(|(column, selection)| selection.holds(&self.value(column).to_string()))
    }

    /// Whether a number that is needed is not there, as where rows of several kinds share a table.
    fn incomplete(&self) -> bool {
        let layout = self.layout;
        let needed = [
            layout.time.as_ref(),
            Some(&layout.command),
            Some(&layout.angle),
            layout.current.as_ref(),
            layout.enabled.as_ref(),
            layout.direction.as_ref(),
        ];
        needed
            .into_iter()
            .flatten()
            .any(|column| self.value(column).is_nan())
    }

    fn error(&self, column: Option<&Column>, fault: ReadFault) -> ReadError {
        let place = match column {
            Some(column) => Place::cell(self.name, self.row, &column.cell),
            None => Place::line(self.name, self.row),
        };
        ReadError::new(place, fault)
    }

    fn number(
        &self,
        column: &Column,
        convert: impl Fn(f64) -> Result<f64, ReadFault>,
    ) -> Result<f64, ReadError> {
        let value = self.value(column);
        let converted = checked(value).and_then(convert).and_then(checked);
        converted.map_err(|fault| self.error(Some(column), fault))
    }

    /// Seconds: of a column that holds times as the log tells them, else in the motor file's unit.
    fn time(&self, column: &Column, kind: Kind) -> Result<f64, ReadError> {
        match kind {
            Kind::Time => self.number(column, Ok),
            _ => self.number(column, |time| self.scale.time(time)),
        }
    }

    fn sample(&self, time_s: f64) -> Result<Sample, ReadError> {
        let layout = self.layout;
        let direction = layout.direction.as_ref();
        let direction = direction.map(|column| self.value(column));
        let command = self.number(&layout.command, |command| {
            self.scale.command(directed(command, direction))
        })?;
        let current = layout.current.as_ref();
        let current_a = current
            .map(|column| self.number(column, |x| self.scale.current(x)))
            .transpose()?;
        let temperature = layout.temperature.as_ref();
        let told = |column: &&Column| !self.value(column).is_nan();
        let temperature_c = temperature
            .filter(told)
            .map(|column| self.number(column, |x| self.scale.temperature(x)))
            .transpose()?;
        let enabled = layout
            .enabled
            .as_ref()
            .map(|column| match self.value(column) {
                1.0 => Ok(true),
                0.0 => Ok(false),
                other => {
                    let text = other.to_string();
                    Err(self.error(Some(column), ReadFault::NotASwitch { text }))
                }
            });
        Ok(Sample {
            time_s,
            command,
            counts: self.number(&layout.angle, |angle| self.scale.counts(angle))?,
            current_a,
            temperature_c,
            enabled: enabled.transpose()?,
        })
    }
}
