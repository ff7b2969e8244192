//! Which entries a data log has.

use super::layout::{Layout, text};
use super::records::{Head, Records, damaged};
use crate::bytes::Bytes;
use crate::error::FormatError;
use crate::log::{Column, Kind, Table};
use crate::parquet::MOST_COLUMNS_OF_ALL;
use std::collections::HashMap;
use std::sync::Arc;

/// Bytes of a record that says something of an entry, or what a structure is made of.
const MOST_BYTES: u64 = 1 << 20;
/// The type of the entries that say what a structure is made of, and what their names end with.
const SCHEMA: (&str, &str) = ("structschema", "struct:");

/// Which entry each number is at a moment: numbers are used again.
#[derive(Clone, Debug, Default)]
pub(super) struct Entries {
    /// Each entry by its name and its type.
    known: HashMap<(String, String), usize>,
    /// The entry that a number is.
    open: HashMap<u32, usize>,
}

/// What a record says of an entry.
enum Said {
    Start {
        name: String,
        kind: String,
        metadata: String,
    },
    Metadata(String),
    Finish,
}

/// What is known of an entry once the file was read.
#[derive(Debug)]
struct Seen {
    name: String,
    kind: String,
    metadata: String,
    rows: u64,
    /// Bytes of the longest record.
    most: u64,
}

impl Entries {
    /// The entry that a record is of.
    pub(super) fn of(&self, head: Head) -> Option<usize> {
        self.open.get(&head.entry).copied()
    }

    /// Keeps to what a record about entries says.
    pub(super) fn follow(&mut self, records: &mut Records, head: Head) -> Result<(), FormatError> {
        let (number, said) = said(records, head)?;
        match said {
            Said::Start { name, kind, .. } => {
                if let Some(entry) = self.known.get(&(name, kind)) {
                    self.open.insert(number, *entry);
                }
            }
            Said::Finish => {
                self.open.remove(&number);
            }
            Said::Metadata(_) => {}
        }
        Ok(())
    }
}

/// What a file holds.
pub(super) struct Found {
    /// Which entry each number is.
    pub(super) entries: Entries,
    /// The table of each entry.
    pub(super) tables: Vec<Table>,
    /// The layout of those that hold numbers.
    pub(super) layouts: Vec<Option<Arc<Layout>>>,
}

/// Reads the whole file for its entries. A file that was cut short has those before the cut.
pub(super) fn entries(records: &mut Records) -> Result<Found, FormatError> {
    let mut entries = Entries::default();
    let (mut seen, mut schemas) = (Vec::new(), HashMap::new());
    let scanned = scan(records, &mut entries, &mut seen, &mut schemas);
    if let (Err(error), true) = (scanned, seen.is_empty()) {
        return Err(error);
    }
    let mut known: HashMap<String, Option<Arc<Layout>>> = HashMap::new();
    let (mut tables, mut layouts, mut left) = (Vec::new(), Vec::new(), MOST_COLUMNS_OF_ALL);
    for entry in seen {
        let layout = known.entry(entry.kind);
        let layout = layout.or_insert_with_key(|kind| Layout::of(kind, &schemas).map(Arc::new));
        let layout = layout.clone().filter(|_| left > 0);
        let mut columns = vec![Column {
            name: "timestamp".to_owned(),
            kind: Kind::Time,
            unit: None,
        }];
        match &layout {
            Some(layout) => {
                let unit = unit(&entry.metadata);
                let elements = layout.elements_within(entry.most);
                layout.columns(elements, unit.as_ref(), &mut columns);
            }
            None => columns.push(text()),
        }
        left = left.saturating_sub(columns.len());
        tables.push(Table {
            name: entry.name,
            rows: Some(entry.rows),
            columns,
        });
        layouts.push(layout);
    }
    entries.open.clear();
    Ok(Found {
        entries,
        tables,
        layouts,
    })
}

fn scan(
    records: &mut Records,
    entries: &mut Entries,
    seen: &mut Vec<Seen>,
    schemas: &mut HashMap<String, String>,
) -> Result<(), FormatError> {
    let mut content = Vec::new();
    records.rewind()?;
    while let Some(head) = records.next()? {
        if head.entry == 0 {
            let (number, said) = said(records, head)?;
            match said {
                Said::Start {
                    name,
                    kind,
                    metadata,
                } => {
                    let key = (name.clone(), kind.clone());
                    let entry = *entries.known.entry(key).or_insert_with(|| {
                        seen.push(Seen {
                            name,
                            kind,
                            metadata,
                            rows: 0,
                            most: 0,
                        });
                        seen.len() - 1
                    });
                    entries.open.insert(number, entry);
                }
                Said::Metadata(metadata) => {
                    let entry = entries.open.get(&number);
                    if let Some(seen) = entry.and_then(|entry| seen.get_mut(*entry)) {
                        seen.metadata = metadata;
                    }
                }
                Said::Finish => {
                    entries.open.remove(&number);
                }
            }
            continue;
        }
        let entry = entries.of(head).and_then(|entry| seen.get_mut(entry));
        let Some(entry) = entry else {
            records.skip(head, head.size)?;
            continue;
        };
        entry.rows = entry.rows.saturating_add(1);
        if entry.kind == SCHEMA.0
            && let Some((_, name)) = entry.name.rsplit_once(SCHEMA.1)
        {
            records.content(head, MOST_BYTES, &mut content)?;
            let schema = String::from_utf8_lossy(&content).into_owned();
            schemas.insert(name.to_owned(), schema);
            continue;
        }
        entry.most = entry.most.max(head.size);
        records.skip(head, head.size)?;
    }
    Ok(())
}

/// What a record about entries says, and of which number.
fn said(records: &mut Records, head: Head) -> Result<(u32, Said), FormatError> {
    let mut content = Vec::new();
    records.content(head, MOST_BYTES, &mut content)?;
    let mut bytes = Bytes::new(&content);
    let said = (|| {
        let (kind, number) = (bytes.u8()?, bytes.u32()?);
        let said = match kind {
            0 => Said::Start {
                name: bytes.text()?,
                kind: bytes.text()?,
                metadata: bytes.text()?,
            },
            1 => Said::Finish,
            2 => Said::Metadata(bytes.text()?),
            _ => return None,
        };
        Some((number, said))
    })();
    said.ok_or_else(|| {
        records.fail(
            head.at,
            damaged("a record about an entry says nothing of it"),
        )
    })
}

/// The unit that an entry's metadata say.
fn unit(metadata: &str) -> Option<String> {
    let said: serde_json::Value = serde_json::from_str(metadata).ok()?;
    let unit = said.get("unit").or_else(|| said.get("units"))?.as_str()?;
    (!unit.is_empty()).then(|| unit.to_owned())
}
