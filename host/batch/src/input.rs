//! The recordings of a batch, one at a time: a folder may hold more than memory does.

use crate::columns::Columns;
use crate::error::{Error, content, io as refused};
use crate::shard::Shard;
use arrow_array::cast::AsArray;
use arrow_array::types::{
    Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type, UInt8Type, UInt16Type,
    UInt32Type, UInt64Type,
};
use arrow_array::{
    ArrayRef, BooleanArray, FixedSizeListArray, LargeListArray, ListArray, RecordBatch,
};
use arrow_schema::{DataType, Field, FieldRef};
use parquet::arrow::arrow_reader::{ParquetRecordBatchReaderBuilder, RowSelection};
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
        /// The rows of each of its row groups.
        groups: Vec<usize>,
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
        let groups = builder.metadata().row_groups().iter();
        Ok(Input::Parquet {
            path: path.to_owned(),
            groups: groups
                .map(|group| usize::try_from(group.num_rows()).unwrap_or(0))
                .collect(),
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
            Input::Parquet { groups, .. } => groups.iter().sum(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The path that was opened.
    pub fn path(&self) -> &Path {
        match self {
            Input::Folder { path, .. } | Input::Parquet { path, .. } => path,
        }
    }

    /// How many recordings a shard has.
    pub fn count(&self, shard: Shard) -> usize {
        match self {
            Input::Parquet { groups, .. } => {
                let own = own_rows(groups, shard);
                own.iter().map(|(_, rows)| rows.len()).sum()
            }
            Input::Folder { files, .. } => shard.numbers(files.len() as u64).count(),
        }
    }

    /// Gives each recording of a shard to `each`, in order, until that says that it wants no more.
    pub(crate) fn each(
        &self,
        shard: Shard,
        mut each: impl FnMut(Unit) -> bool,
    ) -> Result<(), Error> {
        match self {
            Input::Folder { path, files } => {
                let own = (0_u64..)
                    .zip(files)
                    .filter(|(number, _)| shard.has(*number));
                for (_, file) in own {
                    let name = file.strip_prefix(path).unwrap_or(file);
                    let unit = Unit {
                        name: name.to_string_lossy().replace('\\', "/"),
                        content: Content::File(Log::at(file)),
                    };
                    if !each(unit) {
                        break;
                    }
                }
                Ok(())
            }
            Input::Parquet { path, groups } => {
                for (group, own) in own_rows(groups, shard) {
                    if !rows(path, group, &own, &mut each)? {
                        break;
                    }
                }
                Ok(())
            }
        }
    }
}

/// The row groups that a shard reads, each with the numbers of its rows within the file that are the shard's. What is read is
/// whole groups where there are as many as shards, so that no machine decodes what others need.
fn own_rows(groups: &[usize], shard: Shard) -> Vec<(usize, Vec<usize>)> {
    let by_group = groups.len() as u64 >= shard.count();
    let mut first = 0;
    let mut own = Vec::new();
    for (group, &rows) in groups.iter().enumerate() {
        let mut numbers: Vec<usize> = (first..first + rows).collect();
        first += rows;
        if by_group && !shard.has(group as u64) {
            continue;
        }
        if !by_group {
            numbers.retain(|number| shard.has(*number as u64));
        }
        if !numbers.is_empty() {
            own.push((group, numbers));
        }
    }
    own
}

/// Gives the rows `own` of a row group, by their numbers in the file; whether more are wanted.
fn rows(
    path: &Path,
    group: usize,
    own: &[usize],
    each: &mut impl FnMut(Unit) -> bool,
) -> Result<bool, Error> {
    let file = File::open(path).map_err(refused(path))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(content(path))?;
    let before = builder.metadata().row_groups().iter().take(group);
    let first: i64 = before.map(|group| group.num_rows()).sum();
    let first = usize::try_from(first).unwrap_or(0);
    let selected = own.iter().map(|number| number - first..number - first + 1);
    let total = usize::try_from(builder.metadata().row_group(group).num_rows()).unwrap_or(0);
    let selected = RowSelection::from_consecutive_ranges(selected, total);
    let reader = builder
        .with_row_groups(vec![group])
        .with_row_selection(selected)
        .with_batch_size(ROWS)
        .build()
        .map_err(content(path))?;
    let mut numbers = own.iter();
    for batch in reader {
        let batch = batch.map_err(content(path))?;
        let batch = projected(&batch).map_err(content(path))?;
        let columns: Vec<Columns> =
            serde_arrow::from_record_batch(&batch).map_err(content(path))?;
        for (columns, number) in columns.into_iter().zip(&mut numbers) {
            let name = (columns.unit.clone()).unwrap_or_else(|| format!("row {number}"));
            let unit = Unit {
                name,
                content: Content::Columns(Box::new(columns)),
            };
            if !each(unit) {
                return Ok(false);
            }
        }
    }
    Ok(true)
}

/// The columns of a recording, of all that a file has. Counts may be whole numbers, and texts written in several ways: they are read as what they
/// are used as.
fn projected(batch: &RecordBatch) -> Result<RecordBatch, String> {
    let wanted = fields::<Columns>().map_err(|error| error.to_string())?;
    let schema = batch.schema();
    let mut kept = Vec::new();
    for field in wanted {
        match schema.index_of(field.name()) {
            Ok(place) => {
                let own = batch.column(place);
                let own = match of_values(field.data_type()) {
                    DataType::Float64 => with_values(own, &numbers),
                    DataType::Boolean => with_values(own, &flags),
                    _ => own.clone(),
                };
                kept.push((field.name().clone(), own));
            }
            Err(_) if field.is_nullable() => {}
            Err(_) => {
                let has = schema.fields().iter().map(|field| field.name().as_str());
                let has: Vec<&str> = has.collect();
                return Err(format!(
                    "there is no column {}; the file has {}",
                    field.name(),
                    has.join(", ")
                ));
            }
        }
    }
    RecordBatch::try_from_iter(kept).map_err(|error| error.to_string())
}

/// The type of a value, or of those in a list.
fn of_values(wanted: &DataType) -> &DataType {
    match wanted {
        DataType::List(each) | DataType::LargeList(each) => of_values(each.data_type()),
        value => value,
    }
}

/// An array with its values, or those in its lists, made of what they are.
fn with_values(array: &ArrayRef, make: &dyn Fn(&ArrayRef) -> ArrayRef) -> ArrayRef {
    let field = |each: &FieldRef, values: &ArrayRef| {
        let own = values.data_type().clone();
        Arc::new(Field::new(each.name(), own, each.is_nullable()))
    };
    match array.data_type() {
        DataType::List(each) => {
            let (_, offsets, values, nulls) = array.as_list::<i32>().clone().into_parts();
            let values = make(&values);
            Arc::new(ListArray::new(field(each, &values), offsets, values, nulls))
        }
        DataType::LargeList(each) => {
            let (_, offsets, values, nulls) = array.as_list::<i64>().clone().into_parts();
            let values = make(&values);
            Arc::new(LargeListArray::new(
                field(each, &values),
                offsets,
                values,
                nulls,
            ))
        }
        DataType::FixedSizeList(each, _) => {
            let (_, size, values, nulls) = array.as_fixed_size_list().clone().into_parts();
            let values = make(&values);
            Arc::new(FixedSizeListArray::new(
                field(each, &values),
                size,
                values,
                nulls,
            ))
        }
        _ => make(array),
    }
}

/// Whole and single numbers in double precision.
fn numbers(array: &ArrayRef) -> ArrayRef {
    macro_rules! doubled {
        ($kind:ty) => {
            Arc::new((array.as_primitive::<$kind>()).unary::<_, Float64Type>(|x| x as f64))
        };
    }
    match array.data_type() {
        DataType::Int8 => doubled!(Int8Type),
        DataType::Int16 => doubled!(Int16Type),
        DataType::Int32 => doubled!(Int32Type),
        DataType::Int64 => doubled!(Int64Type),
        DataType::UInt8 => doubled!(UInt8Type),
        DataType::UInt16 => doubled!(UInt16Type),
        DataType::UInt32 => doubled!(UInt32Type),
        DataType::UInt64 => doubled!(UInt64Type),
        DataType::Float32 => doubled!(Float32Type),
        _ => array.clone(),
    }
}

/// Flags that are kept as numbers, too.
fn flags(array: &ArrayRef) -> ArrayRef {
    match numbers(array).as_primitive_opt::<Float64Type>() {
        Some(numbers) => Arc::new(BooleanArray::from_unary(numbers, |x| x != 0.0)),
        None => array.clone(),
    }
}

/// The schema of values of a type, as its fields say.
pub(crate) fn fields<T: for<'de> serde::Deserialize<'de>>() -> serde_arrow::Result<Vec<FieldRef>> {
    Vec::<FieldRef>::from_type::<T>(TracingOptions::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use arrow_array::types::Int16Type;
    use arrow_array::{Float64Array, Int32Array};

    #[test]
    fn whole_numbers_in_lists_of_any_kind_are_read_as_what_they_are_used_as() {
        let times =
            ListArray::from_iter_primitive::<Float64Type, _, _>([Some([Some(0.0), Some(0.5)])]);
        let volts =
            LargeListArray::from_iter_primitive::<Int16Type, _, _>([Some([Some(6), Some(-6)])]);
        let counts = FixedSizeListArray::from_iter_primitive::<Int32Type, _, _>(
            [Some([Some(0), Some(90)])],
            2,
        );
        let enabled = ListArray::from_iter_primitive::<UInt8Type, _, _>([Some([Some(1), Some(0)])]);
        let batch = RecordBatch::try_from_iter([
            ("t_s", Arc::new(times) as ArrayRef),
            ("voltage_v", Arc::new(volts)),
            ("angle_counts", Arc::new(counts)),
            ("enabled", Arc::new(enabled)),
            ("counts_per_rev", Arc::new(Int32Array::from(vec![2048]))),
            ("not_asked_for", Arc::new(Float64Array::from(vec![1.0]))),
        ]);
        let batch = projected(&batch.expect("a batch")).expect("the columns");
        let columns: Vec<Columns> = serde_arrow::from_record_batch(&batch).expect("a recording");
        assert_eq!(columns[0].voltage_v, [6.0, -6.0]);
        assert_eq!(columns[0].angle_counts, [0.0, 90.0]);
        assert_eq!(columns[0].enabled, Some(vec![true, false]));
        assert_eq!(columns[0].counts_per_rev, Some(2048.0));
    }
}
