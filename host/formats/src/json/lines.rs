//! JSON lines: one value a row.

use super::cells::{Apart, Cell, Sink};
use super::fault::fault;
use super::lenient::Lenient;
use super::schema::Schema;
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::{Kind, Log, ROWS_AT_A_TIME, Rows, Table};
use crate::origin::Origin;
use crate::plan::MOST_COLUMNS;
use serde::de::DeserializeSeed;
use serde_json::Deserializer;
use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A file of lines. The names of their values are known from a first pass.
struct Lines {
    origin: Origin,
    path: PathBuf,
    schema: Schema,
    tables: [Table; 1],
}

/// Opens the file.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Log>, FormatError> {
    let origin = Origin::new(path, Format::JsonLines);
    let mut found = Found::default();
    let mut rows = 0;
    let read = pass(&origin, path, &mut found, |_| {
        rows += 1;
        ControlFlow::Continue(())
    });
    match read {
        // What was recorded before the cut is handed on, and then the error.
        Err(error) if rows > 0 && matches!(error.fault, FormatFault::CutShort { .. }) => {}
        read => read?,
    }
    Ok(Box::new(Lines {
        origin,
        path: path.to_owned(),
        tables: [Table {
            name: String::new(),
            rows: Some(rows),
            columns: found.schema.columns(),
        }],
        schema: found.schema,
    }))
}

/// Gives every value of a file to a sink, and says after each that a row ends.
fn pass<S: Sink>(
    origin: &Origin,
    path: &Path,
    sink: &mut S,
    mut end: impl FnMut(&mut S) -> ControlFlow<()>,
) -> Result<(), FormatError> {
    let file = File::open(path).map_err(|error| origin.error("", error))?;
    let mut reader = Deserializer::from_reader(Lenient::new(BufReader::new(file)));
    let mut path = String::new();
    while reader.end().is_err() {
        let apart = Apart {
            path: &mut path,
            sink: &mut *sink,
        };
        apart
            .deserialize(&mut reader)
            .map_err(|error| fault(origin, None, error))?;
        path.clear();
        if end(sink).is_break() {
            break;
        }
    }
    Ok(())
}

/// Finds the names of values.
#[derive(Default)]
struct Found {
    schema: Schema,
}

impl Sink for Found {
    fn cell(&mut self, path: &str, cell: Cell<'_>) -> Result<(), FormatFault> {
        // A line with more values than that has a cloud of points among them.
        self.schema.column(path, cell, MOST_COLUMNS as usize);
        Ok(())
    }

    fn refuse(&mut self, _: FormatFault) {}
}

/// Takes the values of the columns that were asked for.
struct Chosen<'l> {
    schema: &'l Schema,
    /// The places of each column of the file in what is handed on.
    outputs: Vec<Vec<usize>>,
    out: Vec<Vec<f64>>,
    rows: usize,
}

impl Chosen<'_> {
    fn clear(&mut self) {
        self.out.iter_mut().for_each(Vec::clear);
        self.rows = 0;
    }

    fn drop_unfinished_row(&mut self) {
        for values in &mut self.out {
            values.truncate(self.rows);
        }
    }

    fn end_row(&mut self) {
        self.rows += 1;
        for values in &mut self.out {
            values.resize(self.rows, f64::NAN);
        }
    }
}

impl Sink for Chosen<'_> {
    fn cell(&mut self, path: &str, cell: Cell<'_>) -> Result<(), FormatFault> {
        let value = match cell {
            Cell::Number(value) => value,
            Cell::Flag(flag) => f64::from(u8::from(flag)),
            Cell::Text(_) | Cell::Missing => return Ok(()),
        };
        let column = self.schema.find(path);
        let outputs = column.and_then(|column| self.outputs.get(column));
        for &output in outputs.into_iter().flatten() {
            if let Some(values) = self.out.get_mut(output) {
                // Of a name that stands twice in a line, the last value counts.
                values.truncate(self.rows);
                values.push(value);
            }
        }
        Ok(())
    }

    fn refuse(&mut self, _: FormatFault) {}
}

impl Log for Lines {
    fn format(&self) -> Format {
        Format::JsonLines
    }

    fn tables(&self) -> &[Table] {
        &self.tables
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let [only] = &self.tables;
        let mut outputs = vec![Vec::new(); self.schema.len()];
        for (output, &at) in columns.iter().enumerate() {
            let (0, Some(column), Some(outputs)) =
                (table, only.columns.get(at), outputs.get_mut(at))
            else {
                return Err(self.origin.error("", FormatFault::Absent));
            };
            if column.kind == Kind::Text {
                return Err(self.origin.error(&column.name, FormatFault::Text));
            }
            outputs.push(output);
        }
        if columns.is_empty() {
            return Ok(());
        }
        let mut chosen = Chosen {
            schema: &self.schema,
            outputs,
            out: vec![Vec::new(); columns.len()],
            rows: 0,
        };
        let mut is_stopped = false;
        let read = pass(&self.origin, &self.path, &mut chosen, |chosen| {
            chosen.end_row();
            if chosen.rows < ROWS_AT_A_TIME {
                return ControlFlow::Continue(());
            }
            let flow = each(&chosen.out);
            is_stopped = flow.is_break();
            chosen.clear();
            flow
        });
        if chosen.rows > 0 && !is_stopped {
            chosen.drop_unfinished_row();
            let _ = each(&chosen.out);
        }
        read
    }
}
