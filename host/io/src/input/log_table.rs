//! Tables of a log by name, and recordings whose columns are in several of them.

use super::cell::checked;
use super::collector::Collector;
use super::log_file::of_format;
use super::motor_file::MotorFile;
use super::place::Place;
use super::reached::Reached;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::sample::Sample;
use super::samples::Further;
use super::scale::Scale;
use super::shown::quoted_list;
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

/// Columns that a user has named by their tables, as in `/joint_states:position[0]`: each with times of its own.
pub(super) struct Joined {
    command: Series,
    angle: Series,
    current: Option<Series>,
    temperature: Option<Series>,
}

/// One column with its times.
struct Series {
    table: usize,
    time: usize,
    column: usize,
}

impl Joined {
    /// The columns, if command and angle are named with their tables and stand in different ones.
    pub(super) fn find(tables: &[Table], motor: &MotorFile) -> Option<Result<Self, ReadFault>> {
        let series = |name: &Option<String>| Series::find(tables, name.as_deref()?);
        let command = series(&motor.columns.voltage)?;
        let angle = series(&motor.columns.angle)?;
        let current = series(&motor.columns.current);
        let temperature = series(&motor.columns.temperature);
        let each = [
            Some(&command),
            Some(&angle),
            current.as_ref(),
            temperature.as_ref(),
        ];
        let without = |series: &&Series| series.time == usize::MAX;
        if let Some(without) = each.into_iter().flatten().find(without) {
            let table = tables[without.table].name.clone();
            return Some(Err(ReadFault::NoClock { table }));
        }
        Some(Ok(Joined {
            command,
            angle,
            current,
            temperature,
        }))
    }

    /// The recording: a sample for each angle, with the last command and current before it.
    pub(super) fn read(
        &self,
        log: &mut dyn Log,
        source: &str,
        motor: &MotorFile,
        scale: &Scale<'_>,
        done: &dyn Fn(Reached),
    ) -> Result<Reading, ReadError> {
        let rows = Cell::new(0);
        let more = |count: u64| {
            rows.set(rows.get() + count);
            done(Reached::of(rows.get(), None));
        };
        let angle = self.angle.read(log, source, &more)?;
        let mut command = Held::new(self.command.read(log, source, &more)?);
        let mut held = |series: &Option<Series>| {
            let series = series.as_ref();
            let read = series.map(|series| series.read(log, source, &more));
            Ok::<_, ReadError>(read.transpose()?.map(Held::new))
        };
        let mut current = held(&self.current)?;
        let mut temperature = held(&self.temperature)?;
        let whole = |fault| ReadError::new(Place::file(source), fault);
        let mut collector = {
            let further = Further {
                current: current.is_some(),
                temperature: temperature.is_some(),
                enabled: false,
            };
            Collector::new(motor, scale, false, further)
        };
        let mut before = 0usize;
        for [time, angle] in angle {
            let held = command.at(time);
            let amperes = current.as_mut().map(|series| series.at(time));
            let (Some(held), None | Some(Some(_))) = (held, amperes) else {
                before += 1;
                continue;
            };
            collector.time(time).map_err(whole)?;
            if !collector.wants(time) {
                continue;
            }
            let convert = |value: Result<f64, ReadFault>| value.and_then(checked).map_err(whole);
            let sample = Sample {
                time_s: time,
                command: convert(scale.command(held))?,
                counts: convert(scale.counts(angle))?,
                current_a: amperes
                    .flatten()
                    .map(|x| convert(scale.current(x)))
                    .transpose()?,
                temperature_c: (temperature.as_mut())
                    .and_then(|series| series.at(time))
                    .map(|x| convert(scale.temperature(x)))
                    .transpose()?,
                enabled: None,
            };
            collector.take(&sample).map_err(whole)?;
        }
        let recordings = collector.finish(source)?;
        let mut notes = vec![format!(
            "{source}: each angle is taken with the last command before it, as the log's own times order them"
        )];
        notes.extend(
            (before > 0).then(|| {
                format!("{source}: {before} angles before the first command are left out")
            }),
        );
        Ok(Reading { recordings, notes })
    }
}

impl Series {
    /// A column by the name of its table, or by both names with a colon between them.
    fn find(tables: &[Table], name: &str) -> Option<Self> {
        let of = |table: usize, column: usize| Series {
            table,
            time: (tables[table].columns.iter())
                .position(|column| column.kind == Kind::Time)
                .unwrap_or(usize::MAX),
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

    /// Times and values, without those that are no numbers. `more` is told of rows as they are read.
    fn read(
        &self,
        log: &mut dyn Log,
        source: &str,
        more: &dyn Fn(u64),
    ) -> Result<Vec<[f64; 2]>, ReadError> {
        let mut all: Vec<[f64; 2]> = Vec::new();
        let mut full = false;
        let read = log.read(self.table, &[self.time, self.column], &mut |rows| {
            let [times, values] = rows else {
                return ControlFlow::Break(());
            };
            more(times.len() as u64);
            let pairs = times
                .iter()
                .zip(values)
                .map(|(time, value)| [*time, *value]);
            let pairs: Vec<[f64; 2]> = pairs
                .filter(|pair| pair.iter().all(|x| !x.is_nan()))
                .collect();
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

/// A value held until the next one.
struct Held {
    series: Vec<[f64; 2]>,
    next: usize,
}

impl Held {
    fn new(series: Vec<[f64; 2]>) -> Self {
        Held { series, next: 0 }
    }

    /// The last value at or before a time; times must not go back.
    fn at(&mut self, time: f64) -> Option<f64> {
        while self
            .series
            .get(self.next)
            .is_some_and(|[at, _]| *at <= time)
        {
            self.next += 1;
        }
        let last = self.next.checked_sub(1)?;
        self.series.get(last).map(|[_, value]| *value)
    }
}
