//! The recordings of a batch, one at a time: a folder may hold more than memory does.

use crate::columns::Columns;
use crate::error::{Error, content, io as refused};
use arrow_array::RecordBatch;
use arrow_cast::cast;
use arrow_schema::{FieldRef, Schema};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use serde_arrow::schema::{SchemaLike, TracingOptions};
use std::cell::OnceCell;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use walkdir::WalkDir;

/// Rows of a Parquet file that are in memory at a time.
const ROWS: usize = 4;

/// Where recordings come from.
#[derive(Clone, Debug)]
pub enum Input {
    /// The CSV files of a folder and of its folders.
    Folder {
        /// The folder.
        path: PathBuf,
        /// Their paths, in order.
        files: Vec<PathBuf>,
    },
    /// A Parquet file with one row a recording.
    Parquet {
        /// The file.
        path: PathBuf,
        /// Its rows.
        rows: usize,
    },
}

/// One recording of a batch.
pub(crate) struct Unit {
    pub(crate) name: String,
    pub(crate) content: Content,
}

/// What it holds.
pub(crate) enum Content {
    File(Log),
    Columns(Box<Columns>),
}

/// A file, read once by whoever works on it: its digest and its recording are of the same bytes.
pub(crate) struct Log {
    pub(crate) path: PathBuf,
    bytes: OnceCell<io::Result<Vec<u8>>>,
}

impl Log {
    fn at(path: &Path) -> Self {
        Log {
            path: path.to_owned(),
            bytes: OnceCell::new(),
        }
    }

    pub(crate) fn bytes(&self) -> Result<&[u8], &io::Error> {
        let read = self.bytes.get_or_init(|| std::fs::read(&self.path));
        read.as_deref()
    }
}

impl Input {
    /// A folder of logs, or a Parquet file.
    ///
    /// # Errors
    /// What cannot be read, or holds no recording.
    pub fn open(path: &Path) -> Result<Self, Error> {
        if path.is_dir() {
            return Self::folder(path);
        }
        let file = File::open(path).map_err(refused(path))?;
        let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(content(path))?;
        let rows = builder.metadata().file_metadata().num_rows();
        Ok(Input::Parquet {
            path: path.to_owned(),
            rows: usize::try_from(rows).unwrap_or(0),
        })
    }

    fn folder(path: &Path) -> Result<Self, Error> {
        let mut files = Vec::new();
        for entry in WalkDir::new(path).sort_by_file_name() {
            let entry = entry.map_err(|why| Error::Io {
                path: path.to_owned(),
                why: why.into(),
            })?;
            let is_csv =
                (entry.path().extension()).is_some_and(|end| end.eq_ignore_ascii_case("csv"));
            if entry.file_type().is_file() && is_csv {
                files.push(entry.into_path());
            }
        }
        if files.is_empty() {
            return Err(Error::Usage(format!(
                "{}: no CSV file is in this folder or in its folders; name another, or a Parquet file",
                path.display()
            )));
        }
        Ok(Input::Folder {
            path: path.to_owned(),
            files,
        })
    }

    /// How many recordings there are.
    pub fn len(&self) -> usize {
        match self {
            Input::Folder { files, .. } => files.len(),
            Input::Parquet { rows, .. } => *rows,
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Gives each recording with its number to `each`, in order, until that says that it wants no more.
    pub(crate) fn each(&self, mut each: impl FnMut(usize, Unit) -> bool) -> Result<(), Error> {
        match self {
            Input::Folder { path, files } => {
                for (number, file) in files.iter().enumerate() {
                    let name = file.strip_prefix(path).unwrap_or(file);
                    let unit = Unit {
                        name: name.to_string_lossy().replace('\\', "/"),
                        content: Content::File(Log::at(file)),
                    };
                    if !each(number, unit) {
                        break;
                    }
                }
                Ok(())
            }
            Input::Parquet { path, .. } => rows(path, each),
        }
    }
}

fn rows(path: &Path, mut each: impl FnMut(usize, Unit) -> bool) -> Result<(), Error> {
    let file = File::open(path).map_err(refused(path))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(content(path))?;
    let reader = builder
        .with_batch_size(ROWS)
        .build()
        .map_err(content(path))?;
    let mut number = 0;
    for batch in reader {
        let batch = batch.map_err(content(path))?;
        let batch = in_doubles(&batch).map_err(content(path))?;
        let columns: Vec<Columns> =
            serde_arrow::from_record_batch(&batch).map_err(content(path))?;
        for columns in columns {
            let name = (columns.unit.clone()).unwrap_or_else(|| format!("row {number}"));
            let unit = Unit {
                name,
                content: Content::Columns(Box::new(columns)),
            };
            if !each(number, unit) {
                return Ok(());
            }
            number += 1;
        }
    }
    Ok(())
}

/// The columns of a recording in the types in which they are used: other programs write counts as whole numbers, and texts in
/// several ways.
fn in_doubles(batch: &RecordBatch) -> Result<RecordBatch, String> {
    let wanted = fields::<Columns>().map_err(|error| error.to_string())?;
    let (mut kept, mut arrays) = (Vec::new(), Vec::new());
    for field in wanted {
        let Some(array) = batch.column_by_name(field.name()) else {
            if field.is_nullable() {
                continue;
            }
            let schema = batch.schema();
            let has: Vec<&str> = schema
                .fields()
                .iter()
                .map(|field| field.name().as_str())
                .collect();
            return Err(format!(
                "there is no column {}; the file has {}",
                field.name(),
                has.join(", ")
            ));
        };
        let array = cast(array, field.data_type());
        arrays.push(array.map_err(|error| format!("column {}: {error}", field.name()))?);
        kept.push(field);
    }
    RecordBatch::try_new(Arc::new(Schema::new(kept)), arrays).map_err(|error| error.to_string())
}

/// The schema of values of a type, as its fields say.
pub(crate) fn fields<T: for<'de> serde::Deserialize<'de>>() -> serde_arrow::Result<Vec<FieldRef>> {
    Vec::<FieldRef>::from_type::<T>(TracingOptions::default())
}
