//! One table of a TOML file, read key by key: each value is checked where it stands, so that an error can
//! name its line and character, and keys that nobody asked for are refused.

use std::borrow::Cow;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::motor_error::{MotorFault, MotorFileError};
use super::place::Place;
use super::shown::{quoted_list, shown};
use super::suggest::did_you_mean;

/// The text of a file and its name, to turn byte offsets into places.
#[derive(Clone, Copy)]
pub(super) struct Text<'t> {
    pub(super) source: &'t str,
    pub(super) text: &'t str,
}

impl Text<'_> {
    pub(super) fn error(&self, span: &Range<usize>, fault: MotorFault) -> MotorFileError {
        MotorFileError::new(Place::offset(self.source, self.text, span.start), fault)
    }
}

/// A table whose keys are taken out one by one; [`finish`](Self::finish) refuses what is left.
pub(super) struct Section<'t> {
    text: Text<'t>,
    /// Empty for the top of the file.
    name: &'static str,
    table: DeTable<'t>,
    asked: Vec<&'static str>,
}

/// A value with the place where it stands.
pub(super) struct Found<T> {
    pub(super) value: T,
    pub(super) span: Range<usize>,
}

/// A value that may be written short or long.
pub(super) enum NumberOrTable<'t> {
    Number(f64),
    Table(Section<'t>),
}

type Outcome<T> = Result<T, MotorFileError>;

/// Facts that a user may know to be nothing at all.
const MAY_BE_ZERO: [&str; 5] = [
    "from_s",
    "inductance_h",
    "viscous_n_m_s",
    "damping_v_s_per_rad",
    "dead_band_rad",
];

impl<'t> Section<'t> {
    /// Parses the whole file.
    pub(super) fn top(text: Text<'t>) -> Outcome<Self> {
        let table = DeTable::parse(text.text).map_err(|error| {
            let span = error.span().unwrap_or(0..0);
            text.error(
                &span,
                MotorFault::Syntax(error.message().replace('\n', ", ")),
            )
        })?;
        Ok(Section {
            text,
            name: "",
            table: table.into_inner(),
            asked: Vec::new(),
        })
    }

    /// The table `key`, empty where the file has none.
    pub(super) fn section(&mut self, key: &'static str) -> Outcome<Section<'t>> {
        let (text, name) = (self.text, key);
        let table = match self.take(key) {
            None => DeTable::new(),
            Some((_, DeValue::Table(table))) => table,
            Some((span, other)) => {
                return Err(self.wrong_type(key, &other, &span, "a table, as in [units]"));
            }
        };
        Ok(Section {
            text,
            name,
            table,
            asked: Vec::new(),
        })
    }

    /// A text.
    pub(super) fn string(&mut self, key: &'static str) -> Outcome<Option<Found<String>>> {
        match self.take(key) {
            None => Ok(None),
            Some((span, DeValue::String(value))) => Ok(Some(Found {
                value: value.into_owned(),
                span,
            })),
            Some((span, other)) => Err(self.wrong_type(key, &other, &span, "a text in quotes")),
        }
    }

    /// A column's name: a text that is not empty.
    pub(super) fn column(&mut self, key: &'static str) -> Outcome<Option<String>> {
        match self.string(key)? {
            Some(found) if found.value.trim().is_empty() => Err(self
                .text
                .error(&found.span, MotorFault::EmptyName { key: key.into() })),
            found => Ok(found.map(|found| found.value.trim().to_string())),
        }
    }

    /// One word of a list.
    pub(super) fn word<T: Copy>(
        &mut self,
        key: &'static str,
        all: &[(&str, T)],
    ) -> Outcome<Option<Found<T>>> {
        let Some(Found { value: text, span }) = self.string(key)? else {
            return Ok(None);
        };
        match all.iter().find(|(name, _)| *name == text) {
            Some((_, value)) => Ok(Some(Found {
                value: *value,
                span,
            })),
            None => {
                let names: Vec<&str> = all.iter().map(|(name, _)| *name).collect();
                let hint = format!("allowed: {}", quoted_list(&names));
                let fault = MotorFault::UnknownWord {
                    key: key.into(),
                    text: shown(&text),
                    hint,
                };
                Err(self.text.error(&span, fault))
            }
        }
    }

    /// One word of several lists, and whether a minus stands before it.
    pub(super) fn signed_word<T: Copy>(
        &mut self,
        key: &'static str,
        lists: &[&[(&str, T)]],
    ) -> Outcome<Option<Found<(bool, T)>>> {
        let Some(Found { value: text, span }) = self.string(key)? else {
            return Ok(None);
        };
        let plain = text.strip_prefix('-');
        let word = plain.unwrap_or(&text);
        let mut all = lists.iter().flat_map(|list| list.iter());
        if let Some((_, value)) = all.find(|(name, _)| *name == word) {
            let value = (plain.is_some(), *value);
            return Ok(Some(Found { value, span }));
        }
        let names: Vec<&str> = (lists.iter())
            .flat_map(|list| list.iter().map(|(name, _)| *name))
            .collect();
        let hint = format!(
            "allowed: {}, each also with a minus where the sign is the other one",
            quoted_list(&names)
        );
        let fault = MotorFault::UnknownWord {
            key: key.into(),
            text: shown(&text),
            hint,
        };
        Err(self.text.error(&span, fault))
    }

    /// `true` or `false`.
    pub(super) fn boolean(&mut self, key: &'static str) -> Outcome<Option<Found<bool>>> {
        match self.take(key) {
            None => Ok(None),
            Some((span, DeValue::Boolean(value))) => Ok(Some(Found { value, span })),
            Some((span, other)) => {
                Err(self.wrong_type(key, &other, &span, "true or false, without quotes"))
            }
        }
    }

    /// A finite number greater than zero.
    pub(super) fn positive(&mut self, key: &'static str) -> Outcome<Option<Found<f64>>> {
        match self.take(key) {
            None => Ok(None),
            Some((span, value)) => {
                let value = self.positive_value(key, &value, &span)?;
                Ok(Some(Found { value, span }))
            }
        }
    }

    /// A positive number, or a table for the caller to read on.
    pub(super) fn positive_or_table(
        &mut self,
        key: &'static str,
    ) -> Outcome<Option<Found<NumberOrTable<'t>>>> {
        let Some((span, value)) = self.take(key) else {
            return Ok(None);
        };
        let value = match value {
            DeValue::Table(table) => NumberOrTable::Table(Section {
                text: self.text,
                name: key,
                table,
                asked: Vec::new(),
            }),
            value => NumberOrTable::Number(self.positive_value(key, &value, &span)?),
        };
        Ok(Some(Found { value, span }))
    }

    /// Refuses keys that were not asked for. `elsewhere` tells which other section knows a key.
    pub(super) fn finish(self, elsewhere: impl Fn(&str) -> Option<String>) -> Outcome<()> {
        let first = self.table.keys().min_by_key(|key| key.span().start);
        let Some(key) = first else { return Ok(()) };
        let name: &Cow<'_, str> = key.get_ref();
        let hint = elsewhere(name).unwrap_or_else(|| did_you_mean(name, &self.asked));
        let section = if self.name.is_empty() {
            "at the top".into()
        } else {
            format!("in [{}]", self.name)
        };
        Err(self.text.error(
            &key.span(),
            MotorFault::UnknownKey {
                key: shown(name),
                section,
                hint,
            },
        ))
    }

    /// Where a key stands, without asking for it.
    pub(super) fn span_of(&self, key: &str) -> Option<Range<usize>> {
        self.table.get(key).map(Spanned::span)
    }

    /// An error at a place inside this file.
    pub(super) fn error(&self, span: &Range<usize>, fault: MotorFault) -> MotorFileError {
        self.text.error(span, fault)
    }

    fn take(&mut self, key: &'static str) -> Option<(Range<usize>, DeValue<'t>)> {
        self.asked.push(key);
        let value: Spanned<DeValue<'t>> = self.table.remove(key)?;
        Some((value.span(), value.into_inner()))
    }

    fn positive_value(
        &self,
        key: &'static str,
        value: &DeValue<'_>,
        span: &Range<usize>,
    ) -> Outcome<f64> {
        let text = match value {
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str(),
            DeValue::Float(float) => float.as_str(),
            other => {
                return Err(self.wrong_type(key, other, span, "a decimal number, without quotes"));
            }
        };
        let fault = match text.parse::<f64>() {
            Ok(value) if value.is_finite() && value > 0.0 => return Ok(value),
            Ok(0.0) if MAY_BE_ZERO.contains(&self.name) || MAY_BE_ZERO.contains(&key) => {
                return Ok(0.0);
            }
            Ok(value) if value.is_finite() => MotorFault::NotPositive {
                key: key.into(),
                value,
            },
            _ => MotorFault::NotFinite {
                key: key.into(),
                text: shown(text),
            },
        };
        Err(self.text.error(span, fault))
    }

    fn wrong_type(
        &self,
        key: &'static str,
        seen: &DeValue<'_>,
        span: &Range<usize>,
        wanted: &'static str,
    ) -> MotorFileError {
        self.text.error(
            span,
            MotorFault::WrongType {
                key: key.into(),
                seen: seen.type_str(),
                wanted,
            },
        )
    }
}
