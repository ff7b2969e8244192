//! A Parquet file, of which some columns of some rows are decoded at a time.

use super::footer::Footer;
use super::pages;
use crate::error::{FormatError, FormatFault};
use crate::guard::guarded;
use crate::log::ROWS_AT_A_TIME;
use ::parquet::arrow::ProjectionMask;
use ::parquet::arrow::arrow_reader::{
    ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReader,
    ParquetRecordBatchReaderBuilder,
};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::RowGroupMetaData;
use arrow_array::RecordBatch;
use arrow_schema::{ArrowError, SchemaRef};
use std::collections::HashSet;
use std::fs::File;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Which rows are read.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    /// Row groups; all where there is no choice.
    pub(crate) groups: Option<Vec<usize>>,
    /// Rows of them that are left out first.
    pub(crate) skip: usize,
    /// Rows that are read at most.
    pub(crate) most: Option<usize>,
}

/// A file whose footer was read.
#[derive(Debug)]
pub(crate) struct ParquetFile {
    source: String,
    path: PathBuf,
    metadata: ArrowReaderMetadata,
    /// Column chunks whose pages were looked at, by row group and column.
    looked_at: Mutex<HashSet<(usize, usize)>>,
}

impl ParquetFile {
    pub(crate) fn open(path: &Path) -> Result<Self, FormatError> {
        let source = path.display().to_string();
        let fail = |fault: FormatFault| FormatError::new(&source, "", fault);
        let mut file = File::open(path).map_err(|error| fail(error.into()))?;
        match Footer::of(&mut file).map_err(|error| fail(error.into()))? {
            Footer::Usable => {}
            Footer::Missing => {
                return Err(fail(FormatFault::CutShort {
                    what: "the columns, before the footer that says where they are",
                }));
            }
            Footer::Encrypted => {
                return Err(fail(FormatFault::Unsupported {
                    what: "a Parquet file that is encrypted".to_owned(),
                    remedy: "write it again without encryption".to_owned(),
                }));
            }
            Footer::Damaged => {
                let why = "its footer has no schema that can be read".to_owned();
                return Err(fail(damaged(why)));
            }
        }
        let options = ArrowReaderOptions::new();
        let metadata =
            ArrowReaderMetadata::load(&file, options).map_err(|error| fail(fault(error)))?;
        let said = metadata.metadata().file_metadata().num_rows();
        let opened = ParquetFile {
            source: source.clone(),
            path: path.to_owned(),
            metadata,
            looked_at: Mutex::default(),
        };
        // Rows that are lost must not pass for a table that was short.
        if u64::try_from(said) != Ok(opened.rows()) {
            let why = format!(
                "its footer has {said} rows, and {} in row groups",
                opened.rows()
            );
            return Err(fail(damaged(why)));
        }
        Ok(opened)
    }

    pub(crate) fn source(&self) -> &str {
        &self.source
    }

    pub(crate) fn schema(&self) -> &SchemaRef {
        self.metadata.schema()
    }

    pub(crate) fn groups(&self) -> &[RowGroupMetaData] {
        self.metadata.metadata().row_groups()
    }

    pub(crate) fn rows(&self) -> u64 {
        (self.groups().iter()).fold(0, |rows, group| rows.saturating_add(rows_of(group)))
    }

    /// Gives the columns with the indices `roots`, which are in rising order, batch by batch until `each` breaks.
    pub(crate) fn read(
        &self,
        roots: &[usize],
        part: Part,
        each: &mut dyn FnMut(&RecordBatch) -> Result<ControlFlow<()>, ArrowError>,
    ) -> Result<(), FormatError> {
        let (mut skip, mut left) = (part.skip, part.most.unwrap_or(usize::MAX));
        let groups = part
            .groups
            .unwrap_or_else(|| (0..self.groups().len()).collect());
        let mut row = part.skip;
        for number in groups {
            let Some(group) = self.groups().get(number) else {
                continue;
            };
            let rows = usize::try_from(rows_of(group)).unwrap_or(usize::MAX);
            if skip >= rows {
                skip -= rows;
                continue;
            }
            if left == 0 {
                return Ok(());
            }
            let mut reader = self
                .reader(number, roots, skip, left)
                .map_err(|fault| FormatError::new(&self.source, "", fault))?;
            let mut wanted = left.min(rows - skip);
            skip = 0;
            loop {
                let fail =
                    |fault| FormatError::new(&self.source, format!("after row {row}"), fault);
                let unlike = |error: ArrowError| damaged(error.to_string());
                let batch = decoded(|| reader.next().transpose().map_err(unlike)).map_err(fail)?;
                let Some(batch) = batch else {
                    break;
                };
                wanted = wanted.saturating_sub(batch.num_rows());
                if each(&batch)
                    .map_err(|error| fail(unlike(error)))?
                    .is_break()
                {
                    return Ok(());
                }
                row = row.saturating_add(batch.num_rows());
                left = left.saturating_sub(batch.num_rows());
            }
            if wanted > 0 {
                let why = format!("{wanted} of {rows} rows of a row group are not there");
                return Err(FormatError::new(&self.source, "", damaged(why)));
            }
        }
        Ok(())
    }

    /// A reader of some columns of one row group, once their pages are known to claim no more than there can be.
    fn reader(
        &self,
        group: usize,
        roots: &[usize],
        skip: usize,
        most: usize,
    ) -> Result<ParquetRecordBatchReader, FormatFault> {
        let mut file = File::open(&self.path)?;
        let metadata = self.metadata.metadata();
        let schema = metadata.file_metadata().schema_descr();
        for (leaf, chunk) in metadata.row_group(group).columns().iter().enumerate() {
            if roots.contains(&schema.get_column_root_idx(leaf)) {
                let place = (group, leaf);
                let looked_at = || {
                    self.looked_at
                        .lock()
                        .unwrap_or_else(PoisonError::into_inner)
                };
                if !looked_at().contains(&place) {
                    pages::check(&mut file, chunk)?;
                    looked_at().insert(place);
                }
            }
        }
        let mask = ProjectionMask::roots(schema, roots.iter().copied());
        let builder =
            ParquetRecordBatchReaderBuilder::new_with_metadata(file, self.metadata.clone());
        let builder = builder
            .with_row_groups(vec![group])
            .with_projection(mask)
            .with_batch_size(ROWS_AT_A_TIME.min(most).max(1))
            .with_offset(skip)
            .with_limit(most);
        decoded(|| builder.build().map_err(fault))
    }
}

/// The rows of a row group.
pub(crate) fn rows_of(group: &RowGroupMetaData) -> u64 {
    u64::try_from(group.num_rows()).unwrap_or(0)
}

/// What is wrong with the content of a Parquet file.
pub(crate) fn damaged(why: String) -> FormatFault {
    FormatFault::Damaged {
        format: "Parquet file",
        why,
    }
}

/// What the crate `parquet` makes of bytes that may be damaged.
fn decoded<T>(read: impl FnOnce() -> Result<T, FormatFault>) -> Result<T, FormatFault> {
    let panicked = || damaged("a column is not what the footer says".to_owned());
    guarded(read).unwrap_or_else(|| Err(panicked()))
}

fn fault(error: ParquetError) -> FormatFault {
    match error {
        ParquetError::NYI(what) => FormatFault::Unsupported {
            what,
            remedy: "write the file again without it".to_owned(),
        },
        error => damaged(error.to_string()),
    }
}
