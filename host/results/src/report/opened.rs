//! What a log holds, as text.

use super::fold::folded;
use super::style::{GOOD, HEADING, painted};
use crate::number_text::short;
use crate::schema::opened::{Opened, OpenedColumn, OpenedTable};

/// Columns of a table that are shown one by one.
const SHOWN: usize = 40;

/// The tables, and the command.
pub fn text(opened: &Opened) -> String {
    let count = opened.tables.len();
    let tables = if count == 1 {
        "1 table"
    } else {
        &format!("{count} tables")
    };
    let mut out = format!("{}: {}, {tables}\n", opened.file, opened.format);
    let mut before: Option<&OpenedTable> = None;
    for table in &opened.tables {
        out += &head(table);
        // Episodes have the same columns; once is enough.
        let names = |table: &OpenedTable| -> Vec<String> {
            table
                .columns
                .iter()
                .map(|column| column.name.clone())
                .collect()
        };
        if before.is_some_and(|other| names(other) == names(table)) {
            out += "    the same columns\n";
        } else {
            out += &columns(table);
        }
        before = Some(table);
    }
    for note in &opened.notes {
        out += &format!("{}\n", folded(note, "  "));
    }
    out += &format!("\nTo fit it:\n  {}\n", opened.command);
    for need in &opened.needs {
        out += &format!("{}\n", folded(&format!("  {need}"), "  "));
    }
    out
}

fn head(table: &OpenedTable) -> String {
    let mut said = vec![format!("{} rows", table.rows)];
    // A time that the log itself tells is in seconds.
    let in_seconds = table.columns.iter().any(|column| column.kind == "time");
    let unit = if in_seconds { " s" } else { "" };
    if let (Some(span), Some(interval)) = (table.span, table.interval) {
        said.push(format!("time over {}{unit}", short(span)));
        said.push(format!("every {}{unit}", short(interval)));
    }
    let name = if table.name.is_empty() {
        "(no name)"
    } else {
        &table.name
    };
    format!("  {}  {}\n", painted(HEADING, name), said.join(", "))
}

fn columns(table: &OpenedTable) -> String {
    let shown = table.columns.iter().take(SHOWN);
    let width = shown
        .clone()
        .map(|c| c.name.chars().count())
        .max()
        .unwrap_or(0)
        .min(40);
    let mut out = String::new();
    for column in shown {
        let line = format!("    {:width$}  {:26}", column.name, range(column));
        let guess = column.guess.as_deref().map(|guess| {
            let unit = column.guessed_unit.as_deref();
            painted(
                GOOD,
                unit.map_or(guess.to_owned(), |unit| format!("{guess} ({unit})")),
            )
        });
        out += format!("{line}  {}", guess.unwrap_or_default()).trim_end();
        out.push('\n');
    }
    if table.columns.len() > SHOWN {
        out += &format!("    and {} more columns\n", table.columns.len() - SHOWN);
    }
    out
}

fn range(column: &OpenedColumn) -> String {
    let unit = column
        .unit
        .as_deref()
        .map_or(String::new(), |unit| format!(" {unit}"));
    match (column.kind.as_str(), column.least, column.greatest) {
        ("text", ..) => "text".to_owned(),
        (_, Some(least), Some(greatest)) if least == greatest => {
            format!("always {}{unit}", short(least))
        }
        (_, Some(least), Some(greatest)) => {
            format!("{} to {}{unit}", short(least), short(greatest))
        }
        _ => "no number".to_owned(),
    }
}
