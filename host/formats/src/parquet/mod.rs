//! Parquet: one table of columns, or a recording a row.

mod columns;
mod file;
mod footer;
mod pages;
mod recordings;
mod thrift;
mod values;

pub(crate) use columns::{Source, Step};
pub(crate) use file::{ParquetFile, Part};
pub(crate) use footer::MAGIC;

use crate::batch::{Each, Start, asked};
use crate::detect::Format;
use crate::error::FormatError;
use crate::log::{Column, Log, Rows, Table};
use arrow_array::{ArrayRef, RecordBatch};
use arrow_schema::{ArrowError, DataType};
use columns::flatten;
use std::ops::ControlFlow;
use std::path::Path;
use values::numbers;

/// Rows that are looked at to see how long the lists are.
const SAMPLE: usize = 16;
/// Columns of all tables together: each table has its own list of them.
pub(crate) const MOST_COLUMNS_OF_ALL: usize = 2_000_000;

/// A Parquet file.
pub(crate) struct Parquet {
    file: ParquetFile,
    tables: Vec<Table>,
    sources: Vec<Source>,
    are_recordings: bool,
}

impl Parquet {
    pub(crate) fn open(path: &Path) -> Result<Self, FormatError> {
        let file = ParquetFile::open(path)?;
        let sample = Sample::of(&file)?;
        if let Some(found) = recordings::recordings(&file, &sample) {
            let (columns, sources): (Vec<Column>, Vec<Source>) = found.into_iter().unzip();
            return Ok(Parquet {
                tables: recordings::tables(&file, &columns)?,
                file,
                sources,
                are_recordings: true,
            });
        }
        let (columns, sources) = flat(&file, &sample).into_iter().unzip();
        let table = Table {
            name: String::new(),
            rows: Some(file.rows()),
            columns,
        };
        Ok(Parquet {
            file,
            tables: vec![table],
            sources,
            are_recordings: false,
        })
    }
}

impl Log for Parquet {
    fn format(&self) -> Format {
        Format::Parquet
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
        asked(self.file.source(), &self.tables, table, columns)?;
        let wanted = columns
            .iter()
            .filter_map(|column| self.sources.get(*column));
        let wanted: Vec<&Source> = wanted.collect();
        if wanted.is_empty() {
            return Ok(());
        }
        if self.are_recordings {
            return recordings::read(&self.file, table, &wanted, each);
        }
        rows(&self.file, &wanted, Part::default(), each)
    }
}

/// The first rows of what has lists, which say how long these are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sample {
    roots: Vec<usize>,
    batch: Option<RecordBatch>,
}

impl Sample {
    pub(crate) fn of(file: &ParquetFile) -> Result<Self, FormatError> {
        let fields = file.schema().fields().iter().enumerate();
        let with_lists = fields.filter(|(_, field)| has_lists(field.data_type()));
        let roots: Vec<usize> = with_lists.map(|(root, _)| root).collect();
        let mut batch = None;
        if !roots.is_empty() {
            let part = Part {
                most: Some(SAMPLE),
                ..Part::default()
            };
            file.read(&roots, part, &mut |first| {
                batch = Some(first.clone());
                Ok(ControlFlow::Break(()))
            })?;
        }
        Ok(Sample { roots, batch })
    }

    pub(crate) fn rows(&self) -> usize {
        self.batch.as_ref().map_or(0, RecordBatch::num_rows)
    }

    pub(crate) fn column(&self, root: usize) -> Option<&ArrayRef> {
        let at = self.roots.binary_search(&root).ok()?;
        self.batch.as_ref()?.columns().get(at)
    }
}

fn has_lists(kind: &DataType) -> bool {
    match kind {
        DataType::List(_) | DataType::LargeList(_) | DataType::FixedSizeList(..) => true,
        DataType::Struct(fields) => fields.iter().any(|field| has_lists(field.data_type())),
        _ => false,
    }
}

/// The columns of a file, taken apart.
pub(crate) fn flat(file: &ParquetFile, sample: &Sample) -> Vec<(Column, Source)> {
    let mut out = Vec::new();
    for (root, field) in file.schema().fields().iter().enumerate() {
        let source = Source {
            root,
            steps: Vec::new(),
        };
        flatten(field.name(), field, sample.column(root), source, &mut out);
    }
    out
}

/// Hands on some columns of some rows.
pub(crate) fn rows(
    file: &ParquetFile,
    wanted: &[&Source],
    part: Part,
    each: Each<'_>,
) -> Result<(), FormatError> {
    let mut roots: Vec<usize> = wanted.iter().map(|source| source.root).collect();
    roots.sort_unstable();
    roots.dedup();
    let mut starts = vec![Start::Open; wanted.len()];
    file.read(&roots, part, &mut |batch| {
        let mut out = Vec::with_capacity(wanted.len());
        for (source, start) in wanted.iter().zip(&mut starts) {
            out.push(in_batch(batch, &roots, source, start)?);
        }
        Ok(each(&out))
    })
}

/// The values of one column of a batch that has the columns `roots` of the file.
pub(crate) fn in_batch(
    batch: &RecordBatch,
    roots: &[usize],
    source: &Source,
    start: &mut Start,
) -> Result<Vec<f64>, ArrowError> {
    let at = roots.binary_search(&source.root).ok();
    match at.and_then(|at| batch.columns().get(at)) {
        Some(array) => numbers(array, &source.steps, start),
        None => Ok(vec![f64::NAN; batch.num_rows()]),
    }
}
