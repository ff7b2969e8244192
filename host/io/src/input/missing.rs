//! Columns that a recording must have and has not, and how to map them.

use super::shown::quoted_list;

/// A column that the recording must have and has not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingColumn {
    /// Key in `[columns]`.
    pub key: &'static str,
    /// The name looked for.
    pub wanted: String,
    /// Whether the user's `[columns]` asked for that name.
    pub mapped: bool,
    /// The header's name that comes nearest, and the unit its ending tells.
    pub near: Option<(String, Option<&'static str>)>,
}

/// All missing columns in one message, and the lines that map what the header has.
pub(super) fn missing_text(missing: &[MissingColumn], header: &[String], motor: &str) -> String {
    let wanted: Vec<&str> = missing
        .iter()
        .map(|column| column.wanted.as_str())
        .collect();
    let plural = if missing.len() == 1 {
        "column"
    } else {
        "columns"
    };
    let mut text = format!(
        "no {plural} {}; the header has {}",
        quoted_list(&wanted),
        quoted_list(header)
    );
    if missing.iter().any(|column| column.mapped) {
        text += &format!(" ([columns] in {motor} asks for it)");
    }
    text += &format!(". Say in {motor} which is which:\n    [columns]");
    for column in missing {
        text += &match &column.near {
            Some((near, _)) => format!("\n    {} = {near:?}", column.key),
            None => format!("\n    {} = \"...\"", column.key),
        };
    }
    let units: Vec<String> = missing
        .iter()
        .filter_map(|column| {
            Some(format!(
                "\n    {} = {:?}",
                column.key,
                column.near.as_ref()?.1?
            ))
        })
        .collect();
    if !units.is_empty() {
        text += "\n    [units]";
        text += &units.concat();
    }
    text += "\nor give";
    for column in missing {
        text += &match &column.near {
            Some((near, Some(unit))) => {
                format!(" --column {0}={near} --unit {0}={unit}", column.key)
            }
            Some((near, None)) => format!(" --column {}={near}", column.key),
            None => format!(" --column {}=...", column.key),
        };
    }
    text
}
