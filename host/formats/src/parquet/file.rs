//! A Parquet file, of which some columns of some rows are decoded at a time.

use super::footer::Footer;
use crate::error::{FormatError, FormatFault};
use crate::guard::guarded;
use crate::log::ROWS_AT_A_TIME;
use ::parquet::arrow::ProjectionMask;
use ::parquet::arrow::arrow_reader::{
    ArrowReaderMetadata, ArrowReaderOptions, ParquetRecordBatchReaderBuilder,
};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::RowGroupMetaData;
use arrow_array::RecordBatch;
use arrow_schema::{ArrowError, SchemaRef};
use std::fs::File;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

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
        Ok(ParquetFile {
            source,
            path: path.to_owned(),
            metadata,
        })
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
        let fail = |fault: FormatFault| FormatError::new(&self.source, "", fault);
        let file = File::open(&self.path).map_err(|error| fail(error.into()))?;
        let metadata = self.metadata.clone();
        let builder = ParquetRecordBatchReaderBuilder::new_with_metadata(file, metadata);
        let mask = ProjectionMask::roots(builder.parquet_schema(), roots.iter().copied());
        let most = part.most.unwrap_or(usize::MAX);
        let mut builder = builder
            .with_projection(mask)
            .with_batch_size(ROWS_AT_A_TIME.min(most).max(1))
            .with_offset(part.skip);
        if let Some(most) = part.most {
            builder = builder.with_limit(most);
        }
        if let Some(groups) = part.groups {
            builder = builder.with_row_groups(groups);
        }
        let mut reader = decoded(|| builder.build().map_err(fault)).map_err(fail)?;
        let mut row = part.skip;
        loop {
            let fail = |fault| FormatError::new(&self.source, format!("after row {row}"), fault);
            let unlike = |error: ArrowError| damaged(error.to_string());
            let batch = decoded(|| reader.next().transpose().map_err(unlike)).map_err(fail)?;
            let Some(batch) = batch else {
                return Ok(());
            };
            if each(&batch)
                .map_err(|error| fail(unlike(error)))?
                .is_break()
            {
                return Ok(());
            }
            row = row.saturating_add(batch.num_rows());
        }
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
