//! Looks columns up in a header, and for those that are missing what the header has in their place.

use super::layout::Column;
use super::missing::MissingColumn;
use super::place::{Cell, Place};
use super::read_error::{ReadError, ReadFault};
use super::suggest::nearest;

/// What to look for.
pub(super) struct Wanted<'m> {
    /// Key in `[columns]`.
    pub(super) key: &'static str,
    /// The name under that key.
    pub(super) mapped: Option<&'m str>,
    /// Names where nothing is mapped, best first.
    pub(super) names: &'static [&'static str],
    /// What other people call it, for suggestions only.
    pub(super) aliases: &'static [&'static str],
}

/// Endings of a name that tell its unit.
const ANGLE_ENDINGS: &[(&str, &str)] = &[
    ("_rad", "rad"),
    ("_deg", "deg"),
    ("_degrees", "deg"),
    ("_rev", "rev"),
    ("_turns", "rev"),
    ("_m", "m"),
];
const TIME_ENDINGS: &[(&str, &str)] = &[("_ms", "ms"), ("_us", "us")];

/// A header with its place.
pub(super) struct Finder<'h> {
    pub(super) header: &'h [String],
    pub(super) source: &'h str,
    pub(super) line: u64,
}

impl Finder<'_> {
    /// The column, `None` where the header has it not.
    pub(super) fn find(&self, wanted: &Wanted<'_>) -> Result<Option<Column>, ReadError> {
        let mapped = wanted.mapped.as_slice();
        let names = if mapped.is_empty() {
            wanted.names
        } else {
            mapped
        };
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
                let place = Place::cell(self.source, self.line, &cell);
                let fault = ReadFault::RepeatedColumn { times: found.len() };
                return Err(ReadError::new(place, fault));
            }
            return Ok(Some(Column { index, cell }));
        }
        Ok(None)
    }

    /// What to say about a column that is missing. `taken` are names with a meaning already; the one
    /// suggested here joins them.
    pub(super) fn miss(&self, wanted: &Wanted<'_>, taken: &mut Vec<String>) -> MissingColumn {
        let name = wanted.mapped.unwrap_or(wanted.names[0]);
        let near = self.near(name, wanted.aliases, taken);
        taken.extend(near.map(str::to_string));
        MissingColumn {
            key: wanted.key,
            wanted: name.into(),
            mapped: wanted.mapped.is_some(),
            near: near.map(|near| (near.into(), unit_told_by(near, wanted.key))),
        }
    }

    /// The name most like the one wanted, else an alias, else the name most like an alias.
    fn near(&self, name: &str, aliases: &[&str], taken: &[String]) -> Option<&str> {
        let names = self.header.iter().map(String::as_str);
        let free: Vec<&str> = names
            .filter(|name| !name.is_empty() && !taken.iter().any(|t| t == name))
            .collect();
        let is_alias = |name: &&str| aliases.iter().any(|alias| alias.eq_ignore_ascii_case(name));
        nearest(name, free.iter().copied())
            .or_else(|| free.iter().copied().find(is_alias))
            .or_else(|| {
                aliases
                    .iter()
                    .find_map(|alias| nearest(alias, free.iter().copied()))
            })
    }

    fn matches(&self, test: impl Fn(&str) -> bool) -> Vec<usize> {
        (0..self.header.len())
            .filter(|index| test(&self.header[*index]))
            .collect()
    }
}

fn unit_told_by(name: &str, key: &str) -> Option<&'static str> {
    let endings = match key {
        "angle" | "target" => ANGLE_ENDINGS,
        "time" => TIME_ENDINGS,
        _ => &[],
    };
    let name = name.to_ascii_lowercase();
    let told = endings.iter().find(|(ending, _)| name.ends_with(ending));
    told.map(|(_, unit)| *unit)
}
