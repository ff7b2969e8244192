//! The first rows of a file, as far as they can be read without knowing what its columns mean.

use std::io::{BufRead, Cursor, Read};

use super::dialect::{Dialect, HEAD_BYTES, Names};
use super::lines::Lines;
use super::row::Row;

/// The first rows of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows, each of as many cells as it has.
    pub rows: Vec<Vec<String>>,
    /// What separates the columns.
    pub separator: char,
}

/// Reads at most `rows` rows and `columns` columns as [`read_recording_from`](super::read_recording_from) splits them. What cannot
/// be read ends the preview; the reader says why.
pub fn preview(mut reader: impl BufRead, rows: usize, columns: usize) -> Preview {
    let mut head = Vec::new();
    if reader
        .by_ref()
        .take(HEAD_BYTES as u64)
        .read_to_end(&mut head)
        .is_err()
    {
        return Preview::default();
    }
    let dialect = Dialect::of(&head);
    let mut lines = Lines::new(Cursor::new(head).chain(reader), "");
    let mut row = Row::new(&dialect);
    let mut preview = Preview {
        separator: char::from(row.separator()),
        ..Preview::default()
    };
    for _ in 0..=dialect.before {
        if !matches!(lines.advance(), Ok(true)) {
            return preview;
        }
    }
    let Some(first) = cells(&mut row, lines.bytes(), columns) else {
        return preview;
    };
    preview.header = match &dialect.names {
        Names::Row => first,
        Names::Keys(keys) => keys.iter().take(columns).cloned().collect(),
        Names::Numbers(count) => (1..=(*count).min(columns)).map(|k| k.to_string()).collect(),
    };
    let mut at_first = dialect.names != Names::Row;
    if dialect.units_row && !matches!(lines.advance(), Ok(true)) {
        return preview;
    }
    while preview.rows.len() < rows && (at_first || matches!(lines.advance(), Ok(true))) {
        at_first = false;
        let Some(cells) = cells(&mut row, lines.bytes(), columns) else {
            break;
        };
        preview.rows.push(cells);
    }
    preview
}

fn cells(row: &mut Row, line: &[u8], columns: usize) -> Option<Vec<String>> {
    row.split(line).ok()?;
    let cells = (0..row.len().min(columns)).map(|k| row.cell(k).map(str::to_owned));
    cells.collect::<Result<_, _>>().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_split_as_the_reader_splits_them() {
        let text = "# made by hand\n\n\"t, s\";u\n1;\"2;3\"\n4;5\n6;7\n";
        let found = preview(text.as_bytes(), 2, 10);
        assert_eq!(found.header, ["t, s", "u"]);
        assert_eq!(found.rows, [["1", "2;3"], ["4", "5"]]);
        assert_eq!(found.separator, ';');
    }

    #[test]
    fn whatever_it_is_gives_a_preview() {
        for text in [
            "",
            "\n\n",
            "#",
            "\u{0}\u{1}",
            ",,,,",
            "{\"a\": 1}",
            "a,b\n\"open",
            &"x,".repeat(5000),
        ] {
            let found = preview(text.as_bytes(), 3, 200);
            assert!(found.header.len() <= 200 && found.rows.len() <= 3);
        }
    }
}
