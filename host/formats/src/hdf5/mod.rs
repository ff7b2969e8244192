//! HDF5, which MATLAB's files of version 7.3 are, too.
//!
//! | file | holds |
//! |---|---|
//! | `element` | elements of datasets as numbers |
//! | `stored` | a dataset whose rows are read some at a time |
//! | `dataset` | a dataset as a variable |
//! | `references` | what references of MATLAB lead to |
//! | `tree` | groups as variables |

mod dataset;
mod element;
mod references;
mod stored;
mod tree;

use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::guard;
use crate::log::{Kind, Log, ROWS_AT_A_TIME, Rows, Table};
use crate::matlab::Tables;
use crate::origin::Origin;
use crate::plan::{Plan, Source};
use hdf5_reader::error::Error;
use hdf5_reader::{FileStorage, Hdf5File, OpenOptions};
use std::collections::BTreeMap;
use std::fs::File;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use stored::Stored;
use tree::Tree;

const MAGIC: &[u8] = b"\x89HDF\r\n\x1a\n";
/// Where a file may begin: other programs may have written before it.
const STARTS: [usize; 4] = [0, 512, 1024, 2048];
/// How MATLAB begins what it writes before it.
const MATLAB: &[u8] = b"MATLAB 7.";
/// Bytes that are read at a time, or kept of what was unpacked, at most.
const MOST_BYTES: usize = 256 << 20;

/// Whether a file with this beginning is one of HDF5.
pub(crate) fn is_hdf5(head: &[u8]) -> bool {
    let begins = |start: &usize| head.get(*start..).is_some_and(|at| at.starts_with(MAGIC));
    head.starts_with(MATLAB) || STARTS.iter().any(begins)
}

/// A file of HDF5.
struct Hdf5 {
    origin: Origin,
    plan: Plan,
    stored: Vec<Stored>,
    is_matlab: bool,
}

/// Does what may meet a description of data that contradicts itself, at which some arithmetic of
/// the library panics in a build that checks for overflow.
fn guarded<T>(
    origin: &Origin,
    work: impl FnOnce() -> Result<T, FormatError>,
) -> Result<T, FormatError> {
    guard::guarded(work)
        .unwrap_or_else(|| Err(origin.damaged("", "its description of the data is damaged")))
}

/// Opens the file, whose first bytes are `head`.
pub(crate) fn open(path: &Path, head: &[u8]) -> Result<Box<dyn Log>, FormatError> {
    let origin = Origin::new(path, Format::Hdf5);
    guarded(&origin.clone(), || walk(origin, path, head))
}

fn walk(origin: Origin, path: &Path, head: &[u8]) -> Result<Box<dyn Log>, FormatError> {
    let file = File::open(path).map_err(|error| origin.error("", error))?;
    let metadata = file.metadata().map_err(|error| origin.error("", error))?;
    let is_matlab = head.starts_with(MATLAB);
    let failed = |error| fault(&origin, is_matlab, "", error);
    let storage = FileStorage::from_file(file).map_err(failed)?;
    let options = OpenOptions::default()
        .with_max_chunk_bytes(MOST_BYTES)
        .with_chunk_cache_bytes(MOST_BYTES)
        .with_max_read_bytes(MOST_BYTES);
    let file = Hdf5File::from_storage_with_options(Arc::new(storage), options).map_err(failed)?;
    let mut tree = Tree::new(&file, metadata.len(), is_matlab);
    let root = file.root_group().map_err(failed)?;
    let fields = tree.fields(&root).map_err(failed)?;
    let mut tables = Tables {
        plan: Plan::default(),
        separator: if is_matlab { "." } else { "/" },
    };
    let made = tables.fields("", fields);
    made.map_err(|fault| origin.error("", fault))?;
    Ok(Box::new(Hdf5 {
        origin,
        plan: tables.plan,
        stored: tree.stored,
        is_matlab,
    }))
}

fn fault(origin: &Origin, is_matlab: bool, place: &str, error: Error) -> FormatError {
    match error {
        Error::Io(error) => origin.failed_read(place, "the values", error),
        Error::UnexpectedEof { .. } | Error::OffsetOutOfBounds(_) => {
            let what = "the values";
            origin.error(place, FormatFault::CutShort { what })
        }
        Error::UnsupportedFilter(filter) => {
            let what = format!("data compressed by {filter}");
            origin.unsupported(place, what, "save it with gzip or without compression")
        }
        Error::ResourceLimit(what) => {
            let limit = MOST_BYTES as u64;
            origin.error(place, FormatFault::TooLarge { what, limit })
        }
        // MATLAB before 2009 wrote what later programs do not.
        error if is_matlab => {
            let what = format!("this variable ({error})");
            origin.unsupported(place, what, "save it again with `save(..., '-v7')`")
        }
        error => origin.damaged(place, error.to_string()),
    }
}

impl Log for Hdf5 {
    fn format(&self) -> Format {
        Format::Hdf5
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
        let (rows, sources) = self.plan.sources(&self.origin, table, columns)?;
        let mut datasets: BTreeMap<usize, Vec<(usize, Source)>> = BTreeMap::new();
        for (output, source) in sources.iter().enumerate() {
            let of = datasets.entry(source.array).or_default();
            of.push((output, *source));
        }
        let stored = |at: usize| {
            let absent = || self.origin.error("", FormatFault::Absent);
            self.stored.get(at).ok_or_else(absent)
        };
        let mut at_a_time = u64::MAX;
        for source in &sources {
            at_a_time = at_a_time.min(stored(source.array)?.rows_at_a_time(source));
        }
        let mut firsts: Vec<Option<f64>> = vec![None; sources.len()];
        let (mut block, mut out) = (vec![Vec::new(); sources.len()], Vec::new());
        let mut start = 0;
        while start < rows && !sources.is_empty() {
            let end = rows.min(start.saturating_add(at_a_time));
            block.iter_mut().for_each(Vec::clear);
            for (&at, columns) in &datasets {
                let stored = stored(at)?;
                guarded(&self.origin, || {
                    let name = stored.dataset.name();
                    let read = stored.rows(columns, start, end, &mut block);
                    read.map_err(|error| fault(&self.origin, self.is_matlab, name, error))
                })?;
            }
            for ((values, source), first) in block.iter_mut().zip(&sources).zip(&mut firsts) {
                if source.kind == Kind::Time {
                    let known = values.iter().copied().find(|time| !time.is_nan());
                    let first = *first.get_or_insert(known.unwrap_or(0.0));
                    values.iter_mut().for_each(|time| *time -= first);
                }
            }
            for from in (0..(end - start) as usize).step_by(ROWS_AT_A_TIME) {
                out.resize(block.len(), Vec::new());
                for (out, values) in out.iter_mut().zip(&block) {
                    out.clear();
                    let left = values.get(from..).unwrap_or(&[]);
                    out.extend_from_slice(left.get(..ROWS_AT_A_TIME).unwrap_or(left));
                }
                if each(&out).is_break() {
                    return Ok(());
                }
            }
            start = end;
        }
        Ok(())
    }
}
