//! Which part of a log is meant, where it holds more than one recording of one motor: `[log]` of a `motor.toml`.

use super::motor_error::{MotorFault, MotorFileError};
use super::preset::Preset;
use super::read_error::ReadFault;
use super::section::Section;
use super::shown::shown;
use super::suggest::did_you_mean;
use std::fmt;

/// The part of a log that is meant; the default means all of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LogPart {
    /// The program that wrote the log.
    pub preset: Option<&'static Preset>,
    /// The table: a topic, a variable, an episode.
    pub table: Option<String>,
    /// Rows that have these values.
    pub select: Vec<Selection>,
    /// Samples a second, where the log has no time.
    pub rate_hz: Option<f64>,
    /// Begins so long after the first row, s.
    pub from_s: Option<f64>,
    /// Ends so long after the first row, s.
    pub to_s: Option<f64>,
}

/// Rows with a value in a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Selection {
    /// The column's name.
    pub column: String,
    /// The value: a number, or a text as the file has it.
    pub value: String,
}

impl Selection {
    /// Reads `joint=2`.
    pub fn parse(text: &str) -> Option<Self> {
        let (column, value) = text.split_once('=')?;
        let (column, value) = (column.trim(), value.trim());
        (!column.is_empty() && !value.is_empty()).then(|| Selection {
            column: column.to_owned(),
            value: value.to_owned(),
        })
    }

    /// Whether a cell holds the value.
    pub(super) fn holds(&self, cell: &str) -> bool {
        cell == self.value
            || matches!((cell.parse::<f64>(), self.value.parse::<f64>()), (Ok(a), Ok(b)) if a == b)
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.column, self.value)
    }
}

impl LogPart {
    /// Refuses a selection that none of the rows met; `taken` are those that did.
    pub(super) fn check_met(&self, taken: u64) -> Result<(), ReadFault> {
        if taken > 0 || self.select.is_empty() {
            return Ok(());
        }
        let all: Vec<String> = self.select.iter().map(Selection::to_string).collect();
        Err(ReadFault::NothingSelected {
            selection: all.join(" and "),
        })
    }
}

/// Reads `[log]`.
pub(super) fn log_part(mut section: Section<'_>) -> Result<LogPart, MotorFileError> {
    let mut select = Vec::new();
    if let Some(found) = section.string("select")? {
        for text in found.value.split(',') {
            let Some(selection) = Selection::parse(text) else {
                let text = shown(text);
                return Err(section.error(&found.span, MotorFault::Selection { text }));
            };
            select.push(selection);
        }
    }
    let from = section.positive("from_s")?;
    let to = section.positive("to_s")?;
    if let Some(to) = &to {
        let from = from.as_ref().map_or(0.0, |from| from.value);
        if to.value <= from {
            let fault = MotorFault::Span { from, to: to.value };
            return Err(section.error(&to.span, fault));
        }
    }
    let preset = section.string("preset")?;
    let preset = preset.map(|found| match Preset::by_name(&found.value) {
        Some(preset) => Ok(preset),
        None => {
            let fault = MotorFault::UnknownWord {
                key: "preset".into(),
                text: shown(&found.value),
                hint: did_you_mean(&found.value, &Preset::names()),
            };
            Err(section.error(&found.span, fault))
        }
    });
    let part = LogPart {
        preset: preset.transpose()?,
        table: section.column("table")?,
        select,
        rate_hz: section.positive("rate_hz")?.map(|found| found.value),
        from_s: from.map(|found| found.value),
        to_s: to.map(|found| found.value),
    };
    section.finish(|key| super::motor_parse::home_of(key, "log"))?;
    Ok(part)
}
