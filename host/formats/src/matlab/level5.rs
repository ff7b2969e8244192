//! MATLAB files of level 5, which `save` writes unless `-v7.3` is asked for.

use super::gather::{Wanted, gather};
use super::matrix::{Found, Variable};
use super::stream::{COMPRESSED, MATRIX, Stream};
use super::tables::Tables;
use super::value::{Fields, Value};
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::{Kind, Log, ROWS_AT_A_TIME, Rows, Table};
use crate::origin::Origin;
use crate::plan::Plan;
use crate::window::Window;
use std::io::{self, Read, Seek, SeekFrom};
use std::ops::ControlFlow;
use std::path::Path;

/// How every writer begins the text in the header.
const MAGIC: &[u8] = b"MATLAB 5.0";
/// Bytes of the header: a text, a version and the order of bytes.
const HEADER: u64 = 128;
/// Bytes of the text.
const TEXT: usize = 124;

/// Whether a file with this beginning is one of level 5.
pub(crate) fn is_level5(head: &[u8]) -> bool {
    head.starts_with(MAGIC) || order(head).is_some()
}

/// Whether the first byte of a number is the most significant one; `None` if that is not told.
fn order(head: &[u8]) -> Option<bool> {
    let is_text = |byte: &u8| byte.is_ascii_graphic() || *byte == b' ';
    head.get(..4).filter(|text| text.iter().all(is_text))?;
    match head.get(TEXT..TEXT + 4)? {
        [0, 1, b'I', b'M'] => Some(false),
        [1, 0, b'M', b'I'] => Some(true),
        _ => None,
    }
}

/// A file of level 5.
struct Level5 {
    origin: Origin,
    plan: Plan,
    found: Found,
    /// Names of variables.
    names: Vec<String>,
    big: bool,
}

/// Opens the file.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Log>, FormatError> {
    let origin = Origin::new(path, Format::Matlab5);
    let mut file = Window::open(path).map_err(|error| origin.error("", error))?;
    let mut header = Vec::new();
    let mut start = file.by_ref().take(HEADER);
    let read = start.read_to_end(&mut header);
    let read = read.map_err(|error| origin.error("", error))?;
    if (read as u64) < HEADER {
        let what = "the header";
        return Err(origin.error("", FormatFault::CutShort { what }));
    }
    let unordered = || origin.damaged("byte 124", "it does not say in which order its bytes are");
    let big = order(&header).ok_or_else(unordered)?;
    let (mut found, mut names, mut fields) = (Found::default(), Vec::new(), Fields::new());
    let mut at = HEADER;
    while at < file.length() {
        let place = format!("variable {} at byte {at}", names.len() + 1);
        let what = "a variable";
        let failed = |error| origin.failed_read(&place, what, error);
        let tag = top(&mut file, at, big).map_err(failed)?;
        let ends = at.saturating_add(8).saturating_add(tag.bytes);
        if ends > file.length() {
            return Err(origin.error(place, FormatFault::CutShort { what }));
        }
        let (begins, is_packed) = match tag.kind {
            COMPRESSED => (at + 8, true),
            MATRIX => (at, false),
            _ => {
                at = ends;
                continue;
            }
        };
        let variable = Variable {
            window: file.part(begins, ends),
            is_packed,
            index: names.len(),
        };
        let mut stream = Stream::new(variable.window.clone(), is_packed, big);
        let (name, value) = found
            .variable(&mut stream, &variable)
            .map_err(|error| origin.failed_read(&place, what, error))?;
        // What has no name is the workspace of functions and objects.
        if !name.is_empty() && !matches!(value, Value::Nothing) {
            fields.push((name.clone(), value));
        }
        names.push(name);
        at = ends;
    }
    let mut tables = Tables {
        plan: Plan::default(),
        separator: ".",
    };
    let made = tables.fields("", fields);
    made.map_err(|fault| origin.error("", fault))?;
    Ok(Box::new(Level5 {
        origin,
        plan: tables.plan,
        found,
        names,
        big,
    }))
}

/// The tag of a variable.
struct Top {
    kind: u32,
    bytes: u64,
}

fn top(file: &mut Window, at: u64, big: bool) -> io::Result<Top> {
    file.seek(SeekFrom::Start(at))?;
    let mut words = [[0; 4]; 2];
    for word in &mut words {
        file.read_exact(word)?;
    }
    let [kind, bytes] = words.map(|word| match big {
        true => u32::from_be_bytes(word),
        false => u32::from_le_bytes(word),
    });
    let bytes = u64::from(bytes);
    Ok(Top { kind, bytes })
}

impl Log for Level5 {
    fn format(&self) -> Format {
        Format::Matlab5
    }

    fn tables(&self) -> &[Table] {
        &self.plan.tables
    }

    fn facts(&self) -> &[(String, String)] {
        &self.plan.facts
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let (_, sources) = self.plan.sources(&self.origin, table, columns)?;
        if columns.is_empty() {
            return Ok(());
        }
        let wanted = sources.iter().enumerate().filter_map(|(output, source)| {
            Some(Wanted {
                output,
                column: source.column,
                along: source.along,
                place: self.found.places.get(source.array)?,
            })
        });
        let gathered = gather(wanted.collect(), columns.len(), self.big);
        let mut whole = gathered.map_err(|(variable, fault)| {
            let name = self.names.get(variable).map_or("", String::as_str);
            match fault {
                FormatFault::Io(error) => self.origin.failed_read(name, "the values", error),
                fault => self.origin.error(name, fault),
            }
        })?;
        for (values, source) in whole.iter_mut().zip(&sources) {
            if source.kind == Kind::Time {
                let first = values.iter().copied().find(|time| !time.is_nan());
                let first = first.unwrap_or(0.0);
                values.iter_mut().for_each(|time| *time -= first);
            }
        }
        let rows = whole.iter().map(Vec::len).min().unwrap_or(0);
        let mut out = vec![Vec::new(); columns.len()];
        for start in (0..rows).step_by(ROWS_AT_A_TIME) {
            let span = start..rows.min(start + ROWS_AT_A_TIME);
            for (out, values) in out.iter_mut().zip(&whole) {
                out.clear();
                out.extend_from_slice(values.get(span.clone()).unwrap_or(&[]));
            }
            if each(&out).is_break() {
                break;
            }
        }
        Ok(())
    }
}
