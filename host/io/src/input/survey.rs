//! What a file holds: its tables, their columns with ranges, and what each is guessed to be. It reads the whole file, some rows at
//! a time, and keeps of them what a drawing shows.

use super::envelope::Envelope;
#[cfg(feature = "formats")]
use super::log_file::{of_format, rows_of};
use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
#[cfg(feature = "formats")]
use super::open::log_of;
use super::open::text_of;
use super::part::Part;
use super::place::Place;
use super::profile::Profile;
use super::proposal::Proposal;
use super::quantity::most_like;
use super::reached::{ROWS_TO_TELL, Reached};
use super::read_error::{ReadError, ReadFault};
use super::text_rows::TextRows;
use crate::channel::Channel;
use crate::median::median;
#[cfg(feature = "formats")]
use servoid_formats::{Kind, Log, Table};
#[cfg(feature = "formats")]
use std::ops::ControlFlow;
use std::path::Path;

#[cfg(feature = "formats")]
/// Tables whose rows are read; further ones are listed.
const TABLES: usize = 64;
/// Columns of a table whose values are looked at; further ones are listed.
const COLUMNS: usize = 512;
#[cfg(feature = "formats")]
/// Columns of all tables whose envelopes are kept: 64 MB.
const ENVELOPES: usize = 4096;

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// The format, for people.
    pub format: String,
    /// Its tables.
    pub tables: Vec<SurveyTable>,
    /// How it may be read.
    pub proposal: Proposal,
    /// What its reader has to say.
    pub notes: Vec<String>,
}

/// One table.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyTable {
    /// Its name; empty where the file has one table.
    pub name: String,
    /// Rows.
    pub rows: u64,
    /// From the first to the last time, in the time's unit; s where the log itself says that they are times.
    pub span: Option<f64>,
    /// Median of the first steps of the time, likewise.
    pub interval: Option<f64>,
    /// Its columns.
    pub columns: Vec<SurveyColumn>,
}

/// One column.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyColumn {
    /// Its name.
    pub name: String,
    /// Whether it holds times, as the log says itself.
    pub is_time: bool,
    /// Whether it holds numbers.
    pub is_number: bool,
    /// Its unit, where the file says it.
    pub unit: Option<String>,
    /// What its values are like.
    pub profile: Profile,
    /// What it may be: a key of `[columns]`.
    pub guess: Option<&'static str>,
    /// The unit that its name tells.
    pub guessed_unit: Option<&'static str>,
    /// Its values over the rows, for a drawing; none of a column whose values are not looked at.
    pub envelope: Option<Envelope>,
}

/// Looks at a file, of each table at most so many rows. `done` is told how far it was read.
///
/// # Errors
/// The file cannot be read, or is damaged.
pub fn survey(
    path: &Path,
    motor: &MotorFile,
    most_rows: Option<u64>,
    done: &dyn Fn(Reached),
) -> Result<Survey, ReadError> {
    let part = Part::of(path);
    let source = part.path.display().to_string();
    let most_rows = most_rows.unwrap_or(u64::MAX);
    #[cfg(feature = "formats")]
    let log = log_of(&part.path, &source)?;
    #[cfg(feature = "formats")]
    let logged = log.map(|mut log| {
        let wanted = part.name.as_deref().or(motor.log.table.as_deref());
        of_log(log.as_mut(), &source, wanted, most_rows, done)
    });
    #[cfg(not(feature = "formats"))]
    let logged: Option<Result<Survey, ReadError>> = None;
    let mut survey = match logged {
        Some(survey) => survey?,
        None => of_text(&part.path, &source, motor, most_rows, done)?,
    };
    survey.proposal = Proposal::of(&survey.tables, motor, survey.is_lerobot());
    survey.proposal.mark(&mut survey.tables);
    Ok(survey)
}

impl Survey {
    fn is_lerobot(&self) -> bool {
        self.format.starts_with("LeRobot")
    }
}

#[cfg(feature = "formats")]
fn of_log(
    log: &mut dyn Log,
    source: &str,
    wanted: Option<&str>,
    most_rows: u64,
    done: &dyn Fn(Reached),
) -> Result<Survey, ReadError> {
    let listed: Vec<Table> = log.tables().to_vec();
    let is_wanted = |table: &&Table| wanted.is_none_or(|name| table.name == name);
    let all = rows_of(listed.iter().filter(is_wanted).take(TABLES));
    let (mut passed, mut envelopes) = (0, ENVELOPES);
    let mut tables = Vec::new();
    for (index, table) in listed.iter().enumerate() {
        if !is_wanted(&table) {
            continue;
        }
        let mut surveyed = SurveyTable::of(table);
        if tables.len() < TABLES {
            let columns: Vec<usize> = (0..table.columns.len())
                .filter(|k| table.columns[*k].kind != Kind::Text)
                .take(COLUMNS)
                .collect();
            for k in columns.iter().take(envelopes) {
                surveyed.columns[*k].envelope = Some(Envelope::default());
            }
            envelopes = envelopes.saturating_sub(columns.len());
            let mut clock = Clock::default();
            let time = table.columns.iter().position(|c| c.kind == Kind::Time);
            let read = log.read(index, &columns, &mut |rows| {
                let count = rows.first().map_or(0, Vec::len);
                surveyed.rows += count as u64;
                passed += count as u64;
                done(Reached::of(passed, all));
                for (k, values) in columns.iter().zip(rows) {
                    let column = &mut surveyed.columns[*k];
                    values.iter().for_each(|value| column.take(*value));
                    if Some(*k) == time {
                        values.iter().for_each(|value| clock.take(*value));
                    }
                }
                if surveyed.rows < most_rows {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            });
            if columns.is_empty() {
                surveyed.rows = table.rows.unwrap_or(0);
            }
            read.map_err(|error| of_format(source, error))?;
            (surveyed.span, surveyed.interval) = clock.told();
        }
        tables.push(surveyed);
    }
    let mut notes = Vec::new();
    if tables.len() > TABLES {
        notes.push(format!(
            "{source}: of {} tables the first {TABLES} were read; name one by --table",
            tables.len()
        ));
    }
    Ok(Survey {
        format: log.format().name().to_owned(),
        tables,
        proposal: Proposal::default(),
        notes,
    })
}

fn of_text(
    path: &Path,
    source: &str,
    motor: &MotorFile,
    most_rows: u64,
    done: &dyn Fn(Reached),
) -> Result<Survey, ReadError> {
    let whole = |error| ReadError::new(Place::file(source), ReadFault::Io(error));
    if path.is_dir() {
        return Err(ReadError::new(Place::file(source), ReadFault::Folder));
    }
    let (text, count) = text_of(path).map_err(whole)?;
    let mut rows = TextRows::new(text, source, motor, true)?;
    let mut table = SurveyTable {
        name: String::new(),
        rows: 0,
        span: None,
        interval: None,
        columns: rows
            .names()
            .iter()
            .map(|name| SurveyColumn::named(name))
            .collect(),
    };
    for column in table.columns.iter_mut().take(COLUMNS) {
        column.envelope = Some(Envelope::default());
    }
    for (column, unit) in table
        .columns
        .iter_mut()
        .zip(rows.units().unwrap_or_default())
    {
        column.unit = Some(unit).filter(|unit| !unit.is_empty());
    }
    let names: Vec<&str> = rows.names().iter().map(String::as_str).collect();
    let said = motor.columns.get(Channel::Time);
    let time = said.or_else(|| most_like(&names, Channel::Time, DriveKind::Voltage));
    let time = names.iter().position(|name| Some(*name) == time);
    let mut clock = Clock::default();
    while table.rows < most_rows
        && let Some(row) = rows.advance()?
    {
        table.rows += 1;
        if table.rows.is_multiple_of(ROWS_TO_TELL) {
            done(count.reached(table.rows));
        }
        for (k, column) in table.columns.iter_mut().enumerate().take(COLUMNS) {
            let Some(cell) = row.get(k) else {
                column.profile.take_text("");
                column.drawn(f64::NAN);
                continue;
            };
            let value = cell.parse::<f64>().unwrap_or(f64::NAN);
            column.profile.take_text(cell);
            column.drawn(value);
            if Some(k) == time {
                clock.take(value);
            }
        }
    }
    for column in &mut table.columns {
        column.is_number = column.profile.is_number();
    }
    (table.span, table.interval) = clock.told();
    Ok(Survey {
        format: "text with columns".to_owned(),
        tables: vec![table],
        proposal: Proposal::default(),
        notes: rows.into_notes(),
    })
}

impl SurveyTable {
    /// How many columns look like something that a recording needs.
    pub fn guessed(&self) -> usize {
        let columns = self.columns.iter();
        columns.filter(|column| column.guess.is_some()).count()
    }

    #[cfg(feature = "formats")]
    fn of(table: &Table) -> Self {
        SurveyTable {
            name: table.name.clone(),
            rows: 0,
            span: None,
            interval: None,
            columns: (table.columns.iter())
                .map(|column| SurveyColumn {
                    is_time: column.kind == Kind::Time,
                    is_number: column.kind != Kind::Text,
                    unit: column.unit.clone(),
                    ..SurveyColumn::named(&column.name)
                })
                .collect(),
        }
    }
}

impl SurveyColumn {
    /// Its unit: as the file says it, as its name tells, or as recordings of our own have it.
    pub fn any_unit(&self) -> Option<&str> {
        let own = match (self.is_time, self.name.as_str()) {
            (true, _) | (_, "t_s") => Some("s"),
            (_, "voltage_v") => Some("V"),
            (_, "angle_counts") => Some("counts"),
            (_, "current_a") => Some("A"),
            (_, "temperature_c") => Some("C"),
            _ => None,
        };
        self.unit.as_deref().or(self.guessed_unit).or(own)
    }

    fn named(name: &str) -> Self {
        SurveyColumn {
            name: name.to_owned(),
            is_time: false,
            is_number: true,
            unit: None,
            profile: Profile::default(),
            guess: None,
            guessed_unit: None,
            envelope: None,
        }
    }

    #[cfg(feature = "formats")]
    fn take(&mut self, value: f64) {
        self.profile.take(value);
        self.drawn(value);
    }

    fn drawn(&mut self, value: f64) {
        if let Some(envelope) = &mut self.envelope {
            envelope.take(value);
        }
    }
}

/// First and last time, and some steps.
#[derive(Default)]
struct Clock {
    first: Option<f64>,
    last: Option<f64>,
    steps: Vec<f64>,
}

impl Clock {
    /// Steps of which the median is taken.
    const STEPS: usize = 1000;

    fn take(&mut self, time: f64) {
        if !time.is_finite() {
            return;
        }
        if let Some(last) = self.last.filter(|_| self.steps.len() < Clock::STEPS) {
            self.steps.push(time - last);
        }
        self.first.get_or_insert(time);
        self.last = Some(time);
    }

    fn told(self) -> (Option<f64>, Option<f64>) {
        let span = self.first.zip(self.last).map(|(first, last)| last - first);
        let interval = median(self.steps);
        (span.filter(|_| interval.is_some()), interval)
    }
}
