//! Where something was seen: `file:line:column`, as compilers and editors write it.

use std::fmt;

/// A place in a text file. Lines and columns count from one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The file as the user named it.
    pub source: String,
    /// Line, when the fault lies on one.
    pub line: Option<u64>,
    /// Column: the cell of a CSV row, the character of a TOML line.
    pub column: Option<usize>,
    /// The cell's name in the header, for a CSV file.
    pub name: Option<String>,
}

/// A cell of a CSV row: its number, from one, and its name in the header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Number of the cell in its row, from one.
    pub number: usize,
    /// Name in the header.
    pub name: String,
}

impl Place {
    /// The file as a whole.
    pub fn file(source: &str) -> Self {
        Place {
            source: source.into(),
            ..Place::default()
        }
    }

    /// One line.
    pub fn line(source: &str, line: u64) -> Self {
        Place {
            line: Some(line),
            ..Place::file(source)
        }
    }

    /// One cell of a CSV file.
    pub fn cell(source: &str, line: u64, cell: &Cell) -> Self {
        Place {
            column: Some(cell.number),
            name: Some(cell.name.clone()),
            ..Place::line(source, line)
        }
    }

    /// The character that begins at byte `offset` of `text`.
    pub fn offset(source: &str, text: &str, offset: usize) -> Self {
        let before = text.get(..offset).unwrap_or(text);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place {
            line: Some(before.matches('\n').count() as u64 + 1),
            column: Some(before[line_start..].chars().count() + 1),
            ..Place::file(source)
        }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.source)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if let Some(column) = self.column {
            write!(f, ":{column}")?;
        }
        if let Some(name) = &self.name {
            write!(f, ": column `{}`", super::shown::shown(name))?;
        }
        Ok(())
    }
}
