//! Files in which each row is a whole recording: lists for the series, and what is the same for all of it beside them.

use super::columns::{Source, column, kind_of, lengths};
use super::file::{ParquetFile, Part, rows_of};
use super::values::leaf;
use super::{MOST_COLUMNS_OF_ALL, Sample};
use crate::batch::{Each, Start};
use crate::error::{FormatError, FormatFault};
use crate::log::{Column, Kind, ROWS_AT_A_TIME, Table};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef};
use arrow_schema::{ArrowError, DataType};
use std::ops::ControlFlow;

/// Lists of one length in all rows that are longer than this are series, and not the joints of a robot.
const MOST_JOINTS: usize = 64;
/// Lists with these names are times.
const TIMES: [&str; 6] = ["t", "t_s", "time", "time_s", "timestamp", "timestamps"];
/// Texts with these names are names of recordings, the first of them that there is.
const NAMES: [&str; 4] = ["unit", "name", "recording", "id"];

/// The columns of a recording, if the rows of the file are recordings: its lists are series of one length in each row, which
/// differs from row to row, or is longer than any robot has joints, or one of them is the time.
pub(crate) fn recordings(file: &ParquetFile, sample: &Sample) -> Option<Vec<(Column, Source)>> {
    let schema = file.schema();
    let fields = schema.fields().iter().enumerate();
    let series: Vec<usize> = fields
        .clone()
        .filter(|(_, field)| series_of(field.data_type()).is_some())
        .map(|(root, _)| root)
        .collect();
    let has_time = (series.iter().filter_map(|root| schema.fields().get(*root)))
        .any(|field| TIMES.contains(&field.name().as_str()));
    let mut found: Vec<usize> = Vec::new();
    let columns: Vec<Vec<Option<usize>>> = series
        .iter()
        .filter_map(|root| sample.column(*root))
        .map(lengths)
        .collect();
    for row in 0..sample.rows() {
        let mut of_row = columns.iter().filter_map(|lengths| *lengths.get(row)?);
        let first = of_row.next()?;
        if of_row.any(|length| length != first) {
            return None;
        }
        found.push(first);
    }
    let first = *found.first()?;
    let are = has_time || first > MOST_JOINTS || found.iter().any(|length| *length != first);
    if series.len() < 2 || !are {
        return None;
    }
    let columns = fields.filter_map(|(root, field)| {
        let kind = kind_of(series_of(field.data_type()).unwrap_or(field.data_type()));
        let source = Source {
            root,
            steps: Vec::new(),
        };
        (kind != Kind::Text).then(|| (column(field.name(), field, kind), source))
    });
    Some(columns.collect())
}

/// A table for each row.
pub(crate) fn tables(file: &ParquetFile, columns: &[Column]) -> Result<Vec<Table>, FormatError> {
    let most = (MOST_COLUMNS_OF_ALL / columns.len().max(1)) as u64;
    if file.rows() > most {
        let fault = FormatFault::Unsupported {
            what: format!("a file of {} recordings", file.rows()),
            remedy: format!("split it into files of {most} at most"),
        };
        return Err(FormatError::new(file.source(), "", fault));
    }
    let schema = file.schema();
    let mut tables: Vec<Table> = Vec::new();
    let mut add = |name: Option<&str>| {
        let row = tables.len();
        tables.push(Table {
            name: name.map_or_else(|| format!("row {row}"), str::to_owned),
            rows: None,
            columns: columns.to_vec(),
        });
    };
    let texts = |name: &&str| {
        let (root, field) = schema.column_with_name(name)?;
        (is_text(field.data_type())).then_some(root)
    };
    let any = || {
        schema
            .fields()
            .iter()
            .position(|field| is_text(field.data_type()))
    };
    let Some(root) = NAMES.iter().find_map(texts).or_else(any) else {
        (0..file.rows()).for_each(|_| add(None));
        return Ok(tables);
    };
    file.read(&[root], Part::default(), &mut |batch| {
        let Some(names) = batch.columns().first() else {
            return Ok(ControlFlow::Break(()));
        };
        each_text(names, &mut add);
        Ok(ControlFlow::Continue(()))
    })?;
    Ok(tables)
}

/// Hands on the recording in the row `row`.
pub(crate) fn read(
    file: &ParquetFile,
    row: usize,
    columns: &[&Source],
    each: Each<'_>,
) -> Result<(), FormatError> {
    let Some((group, skip)) = group_of(file, row) else {
        return Ok(());
    };
    let part = Part {
        groups: Some(vec![group]),
        skip,
        most: Some(1),
    };
    let fields = file.schema().fields().iter();
    let first = fields
        .map(|field| series_of(field.data_type()))
        .position(|item| item.is_some());
    let mut roots: Vec<usize> = columns.iter().map(|source| source.root).collect();
    // How many rows there are is said by a series, also where none is wanted.
    roots.extend(first);
    roots.sort_unstable();
    roots.dedup();
    file.read(&roots, part, &mut |batch| {
        let column = |root: usize| {
            let at = roots.binary_search(&root).ok()?;
            batch.columns().get(at)
        };
        let wanted = columns.iter().map(|source| column(source.root));
        let Some(wanted) = wanted.collect::<Option<Vec<_>>>() else {
            return Ok(ControlFlow::Break(()));
        };
        let rows = batch.columns().iter().filter_map(series);
        let rows: Vec<usize> = rows.map(|series| series.len()).collect();
        let most = rows.iter().copied().max().unwrap_or(0);
        if rows.iter().any(|rows| *rows != most) {
            let why = format!("the lists of row {row} have different lengths");
            return Err(ArrowError::SchemaError(why));
        }
        handed_on(&wanted, most, each)
    })
}

fn handed_on(
    wanted: &[&ArrayRef],
    rows: usize,
    each: Each<'_>,
) -> Result<ControlFlow<()>, ArrowError> {
    let mut starts = vec![Start::Open; wanted.len()];
    for from in (0..rows).step_by(ROWS_AT_A_TIME) {
        let some = ROWS_AT_A_TIME.min(rows - from);
        let mut out = Vec::with_capacity(wanted.len());
        for (array, start) in wanted.iter().zip(&mut starts) {
            out.push(match series(array) {
                Some(series) => leaf(&series.slice(from, some), start)?,
                None if series_of(array.data_type()).is_some() => vec![f64::NAN; some],
                None => {
                    let same = leaf(array, start)?;
                    vec![same.first().copied().unwrap_or(f64::NAN); some]
                }
            });
        }
        if each(&out).is_break() {
            return Ok(ControlFlow::Break(()));
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// The list of the only row; none where it is null or no list.
fn series(array: &ArrayRef) -> Option<ArrayRef> {
    if array.len() != 1 || array.is_null(0) {
        return None;
    }
    if let Some(list) = array.as_list_opt::<i32>() {
        return Some(list.value(0));
    }
    if let Some(list) = array.as_list_opt::<i64>() {
        return Some(list.value(0));
    }
    Some(array.as_fixed_size_list_opt()?.value(0))
}

/// The type of the elements of a list of numbers.
fn series_of(kind: &DataType) -> Option<&DataType> {
    let (DataType::List(item) | DataType::LargeList(item) | DataType::FixedSizeList(item, _)) =
        kind
    else {
        return None;
    };
    (kind_of(item.data_type()) != Kind::Text).then(|| item.data_type())
}

/// The texts of an array, in whichever of several ways it keeps them.
fn each_text(array: &ArrayRef, add: &mut dyn FnMut(Option<&str>)) {
    if let Some(texts) = array.as_string_opt::<i32>() {
        texts.iter().for_each(add);
    } else if let Some(texts) = array.as_string_opt::<i64>() {
        texts.iter().for_each(add);
    } else if let Some(texts) = array.as_string_view_opt() {
        texts.iter().for_each(add);
    } else if let Some(dictionary) = array.as_any_dictionary_opt() {
        let mut all: Vec<Option<String>> = Vec::new();
        each_text(dictionary.values(), &mut |text| {
            all.push(text.map(str::to_owned))
        });
        for (row, key) in dictionary.normalized_keys().into_iter().enumerate() {
            let text = all.get(key).and_then(Option::as_deref);
            add(text.filter(|_| dictionary.is_valid(row)));
        }
    }
}

fn is_text(kind: &DataType) -> bool {
    match kind {
        DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View => true,
        DataType::Dictionary(_, values) => is_text(values),
        _ => false,
    }
}

fn group_of(file: &ParquetFile, row: usize) -> Option<(usize, usize)> {
    let mut first = 0_u64;
    let row = row as u64;
    for (number, group) in file.groups().iter().enumerate() {
        let end = first.saturating_add(rows_of(group));
        if row < end {
            return Some((number, usize::try_from(row - first).ok()?));
        }
        first = end;
    }
    None
}
