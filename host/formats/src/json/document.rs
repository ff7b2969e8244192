//! A document: one value of JSON.

use super::fault::fault;
use super::frame::Room;
use super::lenient::Lenient;
use super::lines;
use super::node::{Node, Reading};
use super::sysid::SysId;
use super::tables::Tables;
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::{Kind, Log, ROWS_AT_A_TIME, Rows, Table};
use crate::origin::Origin;
use serde::de::{DeserializeSeed, IgnoredAny};
use serde_json::Deserializer;
use std::fs::File;
use std::io::BufReader;
use std::ops::ControlFlow;
use std::path::Path;

/// Bytes of a document, which is held as a whole; files of lines have no such limit.
const LONGEST: u64 = 512 << 20;

/// A document.
struct Document {
    origin: Origin,
    format: Format,
    tables: Tables,
}

/// Opens a file that begins with a value of JSON.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Log>, FormatError> {
    let origin = Origin::new(path, Format::Json);
    let failed = |error| origin.error("", error);
    let file = File::open(path).map_err(failed)?;
    let bytes = file.metadata().map_err(failed)?.len();
    let mut reader = Deserializer::from_reader(Lenient::new(BufReader::new(file)));
    if bytes > LONGEST {
        let mut values = reader.into_iter::<IgnoredAny>();
        if values.next().is_some_and(|first| first.is_ok()) && values.next().is_some() {
            return lines::open(path);
        }
        let what = "a document in one piece".to_owned();
        let limit = LONGEST;
        return Err(origin.error("", FormatFault::TooLarge { what, limit }));
    }
    let mut room = Room::of(bytes);
    let reading = Reading { room: &mut room };
    let document = reading.deserialize(&mut reader);
    let document = document.map_err(|error| fault(&origin, room.refused.take(), error))?;
    if reader.end().is_err() && matches!(document, Node::Object(_) | Node::List(_)) {
        return lines::open(path);
    }
    let sysid = SysId::of(&document);
    let format = sysid.as_ref().map_or(Format::Json, |_| Format::SysId);
    let tables = Tables::of(document, sysid.as_ref());
    Ok(Box::new(Document {
        tables: tables.map_err(|fault| origin.error("", fault))?,
        origin,
        format,
    }))
}

impl Log for Document {
    fn format(&self) -> Format {
        self.format
    }

    fn tables(&self) -> &[Table] {
        &self.tables.plan.tables
    }

    fn facts(&self) -> &[(String, String)] {
        &self.tables.plan.facts
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let (rows, sources) = self.tables.plan.sources(&self.origin, table, columns)?;
        if columns.is_empty() {
            return Ok(());
        }
        let origin = |source| {
            let mut values = (0..rows).map(|row| self.tables.value(source, row));
            values.find(|value| !value.is_nan()).unwrap_or(0.0)
        };
        let origins: Vec<f64> = sources
            .iter()
            .map(|source| match source.kind {
                Kind::Time => origin(source),
                _ => 0.0,
            })
            .collect();
        let mut out = vec![Vec::new(); columns.len()];
        for start in (0..rows).step_by(ROWS_AT_A_TIME) {
            let end = rows.min(start + ROWS_AT_A_TIME as u64);
            for ((out, source), origin) in out.iter_mut().zip(&sources).zip(&origins) {
                out.clear();
                out.extend((start..end).map(|row| self.tables.value(source, row) - origin));
            }
            if each(&out).is_break() {
                break;
            }
        }
        Ok(())
    }
}
