//! Looks columns up in a header by the contract's names, or by those that the user maps.

use super::layout::Column;
use super::place::{Cell, Place};
use super::read_error::{ReadError, ReadFault};
use super::shown::shown;
use super::suggest::did_you_mean;
use crate::channel::Channel;

/// What to look for.
pub(super) struct Wanted<'m> {
    /// What it is.
    pub(super) channel: Channel,
    /// The name that the user gives it.
    pub(super) mapped: Option<&'m str>,
    /// Names where nothing is mapped, best first.
    pub(super) names: &'static [&'static str],
}

/// A header with its place.
pub(super) struct Finder<'h> {
    pub(super) header: &'h [String],
    pub(super) source: &'h str,
    pub(super) line: Option<u64>,
}

impl Finder<'_> {
    /// The column, `None` where the header has it not.
    pub(super) fn find(&self, wanted: &Wanted<'_>) -> Result<Option<Column>, ReadError> {
        match &wanted.mapped {
            Some(name) => self.find_any(&[name]),
            None => self.find_any(wanted.names),
        }
    }

    /// The first of these names that the header has.
    fn find_any(&self, names: &[&str]) -> Result<Option<Column>, ReadError> {
        for name in names {
            // `voltage_V` is `voltage_v` unless the file has both.
            let mut found = self.matches(|header| header == *name);
            if found.is_empty() {
                found = self.matches(|header| header.eq_ignore_ascii_case(name));
            }
            let Some(&index) = found.first() else {
                continue;
            };
            let cell = Cell {
                number: index + 1,
                name: self.header[index].clone(),
            };
            if found.len() > 1 {
                let place = Place {
                    line: self.line,
                    ..Place::cell(self.source, 0, &cell)
                };
                let fault = ReadFault::RepeatedColumn { times: found.len() };
                return Err(ReadError::new(place, fault));
            }
            return Ok(Some(Column { index, cell }));
        }
        Ok(None)
    }

    /// The column of this name.
    ///
    /// # Errors
    /// The header has it not, or more than once.
    pub(super) fn named(&self, name: &str) -> Result<Column, ReadError> {
        self.find_any(&[name])?.ok_or_else(|| {
            let names: Vec<&str> = self.header.iter().map(String::as_str).collect();
            let hint = did_you_mean(name, &names);
            let name = shown(name);
            let place = Place {
                line: self.line,
                ..Place::file(self.source)
            };
            ReadError::new(place, ReadFault::NoSelectColumn { name, hint })
        })
    }

    fn matches(&self, test: impl Fn(&str) -> bool) -> Vec<usize> {
        (0..self.header.len())
            .filter(|index| test(&self.header[*index]))
            .collect()
    }
}
