//! Data logs of WPILib: each entry is a table of the moments at which it was written, and of its value then.

mod entries;
mod layout;
mod number;
mod records;

pub(crate) use records::MAGIC;

use crate::batch::{Batch, Value, asked};
use crate::detect::Format;
use crate::error::FormatError;
use crate::log::{Log, Rows, Table};
use entries::{Found, entries};
use records::{Records, damaged};
use std::ops::ControlFlow;
use std::path::Path;

/// A data log.
pub(crate) struct Wpilog {
    records: Records,
    found: Found,
}

impl Wpilog {
    pub(crate) fn open(path: &Path) -> Result<Self, FormatError> {
        let mut records = Records::open(path)?;
        let found = entries(&mut records)?;
        Ok(Wpilog { records, found })
    }

    fn rows(&mut self, table: usize, batch: &mut Batch<'_>) -> Result<(), FormatError> {
        let layout = self.found.layouts.get(table).and_then(Option::as_ref);
        let (records, mut entries) = (&mut self.records, self.found.entries.clone());
        let mut content = Vec::new();
        records.rewind()?;
        while let Some(head) = records.next()? {
            if head.entry == 0 {
                entries.follow(records, head)?;
                continue;
            }
            batch.counts_from(0, i128::from(head.time) * 1000);
            if entries.of(head) != Some(table) {
                records.skip(head, head.size)?;
                continue;
            }
            batch.set(0, Value::Nanoseconds(i128::from(head.time) * 1000));
            match layout {
                Some(layout) => {
                    if layout.elements(head.size).is_none() {
                        let why = format!("a record of {} bytes is not of its type", head.size);
                        return Err(records.fail(head.at, damaged(why)));
                    }
                    records.content(head, layout.most_bytes(), &mut content)?;
                    layout.values(&content, &mut |at, value| {
                        batch.set(at.saturating_add(1), value)
                    });
                }
                None => records.skip(head, head.size)?,
            }
            if batch.end_row().is_break() {
                break;
            }
        }
        Ok(())
    }
}

impl Log for Wpilog {
    fn format(&self) -> Format {
        Format::Wpilog
    }

    fn tables(&self) -> &[Table] {
        &self.found.tables
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let found = asked(self.records.source(), &self.found.tables, table, columns)?;
        if columns.is_empty() {
            return Ok(());
        }
        let mut batch = Batch::new(found.columns.len(), columns, each);
        let outcome = self.rows(table, &mut batch);
        let _ = batch.flush();
        outcome
    }
}
