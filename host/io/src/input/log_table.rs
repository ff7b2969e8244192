//! Tables of a log by name, and recordings whose columns are in several of them.

use super::cell::converted;
use super::cells::{Sample, directed};
use super::collector::Collector;
use super::log_file::of_format;
use super::motor_file::MotorFile;
use super::place::Place;
use super::reached::Reached;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::samples::Further;
use super::scale::Scale;
use super::shown::quoted_list;
use crate::channel::{Channel, Measured, PerMeasured};
use crate::median::median;
use servoid_formats::{Kind, Log, Table};
use std::cell::Cell;
use std::ops::ControlFlow;

/// The names of the tables, for messages.
pub(super) fn names(tables: &[Table]) -> String {
    let names: Vec<&str> = tables.iter().map(|table| table.name.as_str()).collect();
    quoted_list(&names)
}

/// How much a refused table lacks; the one that lacks least is told of.
pub(super) fn missing(fault: &ReadFault) -> usize {
    match fault {
        ReadFault::MissingColumns { missing, .. } => missing
            .iter()
            .map(|m| if m.near.is_some() { 1 } else { 10 })
            .sum(),
        _ => 0,
    }
}

/// Columns that a user has named by their tables, as in `/joint_states:position[0]`: each with times of its own, or all of as many rows
/// as each other.
pub(super) struct Joined {
    series: Vec<(Channel, Series)>,
    /// The column of times that all share, where the user names one in a table that has no times of its own.
    time: Option<Series>,
}

/// One column with its times.
#[derive(Clone, Copy)]
struct Series {
    table: usize,
    time: Option<usize>,
    column: usize,
}

impl Joined {
    /// The columns, if command and angle are named with their tables.
    pub(super) fn find(tables: &[Table], motor: &MotorFile) -> Option<Result<Self, ReadFault>> {
        let named = |channel| Series::find(tables, motor.columns.get(channel)?);
        let series: Vec<(Channel, Series)> = (Channel::ALL.into_iter())
            .filter(|channel| *channel != Channel::Time)
            .filter_map(|channel| Some((channel, named(channel)?)))
            .collect();
        let has = |channel| series.iter().any(|(own, _)| *own == channel);
        if !has(Channel::Command) || !has(Channel::Angle) {
            return None;
        }
        let without = series.iter().find(|(_, series)| series.time.is_none());
        let time = named(Channel::Time);
        let alike = || {
            let rows = |series: &Series| tables[series.table].rows;
            let all = series.iter().map(|(_, series)| series).chain(&time);
            let mut rows = all.map(rows);
            let first = rows.next().flatten();
            first.is_some() && rows.all(|rows| rows == first)
        };
        match without {
            None => Some(Ok(Joined { series, time: None })),
            Some(_) if alike() && (time.is_some() || motor.log.rate_hz.is_some()) => {
                Some(Ok(Joined { series, time }))
            }
            Some((_, without)) => {
                let table = tables[without.table].name.clone();
                Some(Err(ReadFault::NoClock { table }))
            }
        }
    }

    /// The recording: a sample for each time at which any of its columns has a new value, where the others hold.
    pub(super) fn read(
        &self,
        log: &mut dyn Log,
        source: &str,
        motor: &MotorFile,
        done: &dyn Fn(Reached),
    ) -> Result<Reading, ReadError> {
        let rows = Cell::new(0);
        let more = |count: u64| {
            rows.set(rows.get() + count);
            done(Reached::of(rows.get(), None));
        };
        let whole = |fault| ReadError::new(Place::file(source), fault);
        let further = Further {
            measured: (self.series.iter())
                .filter_map(|(channel, _)| match channel {
                    Channel::Measured(channel) => Some(*channel),
                    _ => None,
                })
                .collect(),
            enabled: self.series.iter().any(|(own, _)| *own == Channel::Enabled),
        };
        let scale = Scale::new(motor, &further).map_err(whole)?;
        let mut all = Vec::new();
        for (channel, series) in &self.series {
            let read = match (series.time, &self.time) {
                (Some(time), _) => series.read(Some(time), log, source, &more)?,
                (None, Some(time)) => {
                    let stamps = time.read(None, log, source, &more)?;
                    let values = series.read(None, log, source, &more)?;
                    let pairs = stamps.iter().zip(&values);
                    let pairs = pairs.map(|(stamp, value)| [scale.time(stamp[1]), value[1]]);
                    pairs.collect()
                }
                (None, None) => {
                    let rate = motor.log.rate_hz.unwrap_or(1.0);
                    let values = series.read(None, log, source, &more)?;
                    let pairs = values.iter().map(|[row, value]| [row / rate, *value]);
                    pairs.collect()
                }
            };
            all.push((*channel, read));
        }
        let shared = self.series.iter().any(|(_, series)| series.time.is_none());
        let mut collector = Collector::new(motor, &scale, shared, further);
        let mut merged = Merged::of(all);
        let mut line = 0;
        while let Some((time, row)) = merged.advance() {
            line += 1;
            let timed = collector.time(time, line).map_err(whole)?;
            if collector.wants(timed) {
                let sample = sample(&row, &scale, timed).map_err(whole)?;
                collector.take(&sample).map_err(whole)?;
            }
        }
        let mut reading = collector.finish(source)?;
        if !shared {
            let note = format!(
                "{source}: the columns have times of their own: each holds until its next value"
            );
            reading.notes.insert(0, note);
        }
        Ok(reading)
    }
}

impl Series {
    /// A column by the name of its table, or by both names with a colon between them.
    fn find(tables: &[Table], name: &str) -> Option<Self> {
        let of = |table: usize, column: usize| Series {
            table,
            time: (tables[table].columns.iter()).position(|column| column.kind == Kind::Time),
            column,
        };
        for (k, table) in tables
            .iter()
            .enumerate()
            .filter(|(_, table)| !table.name.is_empty())
        {
            let rest = name.strip_prefix(table.name.as_str());
            if rest == Some("") {
                let mut values = (0..table.columns.len())
                    .filter(|k| matches!(table.columns[*k].kind, Kind::Number | Kind::Flag));
                if let (Some(column), None) = (values.next(), values.next()) {
                    return Some(of(k, column));
                }
            }
            if let Some(column) = rest.and_then(|rest| rest.strip_prefix(':'))
                && let Some(column) = table.columns.iter().position(|c| c.name == column)
            {
                return Some(of(k, column));
            }
        }
        None
    }

    /// Times and values, without those that are no numbers; without a column of times the numbers of the rows. `more` is told of rows as
    /// they are read.
    fn read(
        &self,
        time: Option<usize>,
        log: &mut dyn Log,
        source: &str,
        more: &dyn Fn(u64),
    ) -> Result<Vec<[f64; 2]>, ReadError> {
        let mut all: Vec<[f64; 2]> = Vec::new();
        let mut full = false;
        let asked: Vec<usize> = time.into_iter().chain([self.column]).collect();
        let mut row = 0.0;
        let read = log.read(self.table, &asked, &mut |rows| {
            let Some(values) = rows.last() else {
                return ControlFlow::Break(());
            };
            more(values.len() as u64);
            let mut pairs: Vec<[f64; 2]> = Vec::with_capacity(values.len());
            for (k, value) in values.iter().enumerate() {
                let stamp = time.map_or(row, |_| rows[0][k]);
                row += 1.0;
                if !stamp.is_nan() && !value.is_nan() {
                    pairs.push([stamp, *value]);
                }
            }
            full =
                all.len() + pairs.len() > super::MAX_ROWS || all.try_reserve(pairs.len()).is_err();
            if full {
                return ControlFlow::Break(());
            }
            all.extend(pairs);
            ControlFlow::Continue(())
        });
        read.map_err(|error| of_format(source, error))?;
        if full {
            let limit = super::MAX_ROWS;
            return Err(ReadError::new(
                Place::file(source),
                ReadFault::TooManyRows { limit },
            ));
        }
        // Logs of several writers are not quite in order; equal times keep theirs.
        all.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Ok(all)
    }
}

/// The new values at one time.
type Row = Vec<(Channel, f64)>;

/// Columns with times of their own, put together in the order of these.
struct Merged {
    series: Vec<OneOf>,
    /// Entries so near to each other are of one cycle of the program that wrote them, s.
    cycle_s: f64,
}

struct OneOf {
    channel: Channel,
    values: Vec<[f64; 2]>,
    next: usize,
    /// Whether it is written when it changes, and holds where it is not written. A sampled angle is not known in between.
    holds: bool,
}

/// A gap of so many usual intervals stands in what is written on change alone.
const REST: f64 = 3.0;
/// What a program writes on change in one cycle lies within this part of the cycle.
const CYCLE: f64 = 0.25;

impl Merged {
    fn of(series: Vec<(Channel, Vec<[f64; 2]>)>) -> Self {
        let series = series.into_iter().map(|(channel, values)| OneOf {
            channel,
            next: 0,
            holds: channel != Channel::Angle || on_change(&values),
            values,
        });
        let series: Vec<OneOf> = series.collect();
        let on_change = |one: &&OneOf| one.channel == Channel::Angle && one.holds;
        let angle = series.iter().find(on_change);
        let cycle_s = angle.map_or(0.0, |one| CYCLE * usual_step(&one.values));
        Merged { series, cycle_s }
    }

    /// The next time, and the values at it.
    fn advance(&mut self) -> Option<(f64, Row)> {
        let next = |one: &OneOf| one.values.get(one.next).map(|pair| pair[0]);
        let time = self.series.iter().filter_map(next).reduce(f64::min)?;
        let mut row = Row::new();
        for one in &mut self.series {
            let mut is_new = false;
            while one
                .values
                .get(one.next)
                .is_some_and(|pair| pair[0] <= time + self.cycle_s)
            {
                one.next += 1;
                is_new = true;
            }
            if (is_new || one.holds) && one.next > 0 {
                row.push((one.channel, one.values[one.next - 1][1]));
            }
        }
        Some((time, row))
    }
}

/// Whether values are written when they change: none is that before it, and where nothing changes nothing is written.
fn on_change(values: &[[f64; 2]]) -> bool {
    let same = values.windows(2).any(|pair| pair[0][1] == pair[1][1]);
    let usual = usual_step(values);
    let mut steps = values.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    !same && steps.any(|step| step > REST * usual)
}

/// The median time from one value to the next, s.
fn usual_step(values: &[[f64; 2]]) -> f64 {
    let steps = values.windows(2).map(|pair| pair[1][0] - pair[0][0]);
    median(steps.collect()).unwrap_or(0.0)
}

fn sample(row: &Row, scale: &Scale<'_>, time_s: f64) -> Result<Sample, ReadFault> {
    let value = |channel| {
        row.iter()
            .find(|(own, _)| *own == channel)
            .map(|(_, value)| *value)
    };
    let direction = value(Channel::Direction);
    let command = value(Channel::Command).map(|command| directed(command, direction));
    let convert = |value: Option<f64>, to: &dyn Fn(f64) -> Result<f64, ReadFault>| {
        value.map(|value| converted(value, to)).transpose()
    };
    let mut sample = Sample {
        time_s,
        command: convert(command, &|x| scale.command(x))?,
        counts: convert(value(Channel::Angle), &|x| scale.counts(x))?,
        measured: PerMeasured::default(),
        enabled: value(Channel::Enabled).map(|on| on != 0.0),
    };
    for channel in Measured::ALL {
        let own = value(Channel::Measured(channel));
        sample.measured[channel] = convert(own, &|x| Ok(scale.measured(channel, x)))?;
    }
    Ok(sample)
}
