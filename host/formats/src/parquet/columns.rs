//! The columns of a Parquet file as columns of numbers: lists and structures are taken apart.

use crate::log::{Column, Kind};
use crate::shape::{MOST_COLUMNS, MOST_ELEMENTS};
use arrow_array::cast::AsArray;
use arrow_array::{Array, ArrayRef};
use arrow_schema::{DataType, Field};

/// One step from a column of the file into what it holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// A field of a structure.
    Field(usize),
    /// An element of a list.
    Element(usize),
}

/// Where the values of a column come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Source {
    /// Index of the column in the file.
    pub(crate) root: usize,
    /// The way from there.
    pub(crate) steps: Vec<Step>,
}

/// Adds the columns that a column of the file is taken apart into; its first rows say how long its lists are.
pub(crate) fn flatten(
    name: &str,
    field: &Field,
    sample: Option<&ArrayRef>,
    source: Source,
    out: &mut Vec<(Column, Source)>,
) {
    if out.len() >= MOST_COLUMNS {
        return;
    }
    let deeper = |step| {
        let mut deeper = source.clone();
        deeper.steps.push(step);
        deeper
    };
    match field.data_type() {
        DataType::Struct(fields) if !fields.is_empty() => {
            let parts = sample.and_then(|array| array.as_struct_opt());
            for (at, part) in fields.iter().enumerate() {
                let sample = parts.and_then(|parts| parts.columns().get(at));
                let name = format!("{name}.{}", part.name());
                flatten(&name, part, sample, deeper(Step::Field(at)), out);
            }
        }
        DataType::List(item) | DataType::LargeList(item) | DataType::FixedSizeList(item, _) => {
            let length = match field.data_type() {
                DataType::FixedSizeList(_, length) => usize::try_from(*length).unwrap_or(0),
                _ => (sample.map(lengths).into_iter().flatten().flatten())
                    .max()
                    .unwrap_or(0),
            };
            if length == 0 || length > MOST_ELEMENTS {
                out.push((column(name, field, Kind::Text), source));
                return;
            }
            let sample = sample.and_then(items);
            for at in 0..length {
                let name = format!("{name}[{at}]");
                flatten(&name, item, sample.as_ref(), deeper(Step::Element(at)), out);
            }
        }
        kind => out.push((column(name, field, kind_of(kind)), source)),
    }
}

/// A column that is called so.
pub(crate) fn column(name: &str, field: &Field, kind: Kind) -> Column {
    let said = field.metadata();
    let said = said.get("unit").or_else(|| said.get("units")).cloned();
    let seconds = matches!(field.data_type(), DataType::Duration(_)).then(|| "s".to_owned());
    Column {
        name: name.to_owned(),
        kind,
        unit: seconds.or(said),
    }
}

/// What values of a type are.
pub(crate) fn kind_of(kind: &DataType) -> Kind {
    match kind {
        DataType::Boolean => Kind::Flag,
        DataType::Timestamp(..)
        | DataType::Date32
        | DataType::Date64
        | DataType::Time32(_)
        | DataType::Time64(_) => Kind::Time,
        DataType::Duration(_) => Kind::Number,
        DataType::Dictionary(_, values) => kind_of(values),
        kind if kind.is_numeric() => Kind::Number,
        _ => Kind::Text,
    }
}

/// The length of the list of each row; `None` where it is null. Nothing for what is no list.
pub(crate) fn lengths(array: &ArrayRef) -> Vec<Option<usize>> {
    let row = |row| {
        if array.is_null(row) {
            return None;
        }
        if let Some(list) = array.as_list_opt::<i32>() {
            return usize::try_from(list.value_length(row)).ok();
        }
        if let Some(list) = array.as_list_opt::<i64>() {
            return usize::try_from(list.value_length(row)).ok();
        }
        let list = array.as_fixed_size_list_opt()?;
        usize::try_from(list.value_length()).ok()
    };
    (0..array.len()).map(row).collect()
}

/// All elements of the lists of an array.
fn items(array: &ArrayRef) -> Option<ArrayRef> {
    if let Some(list) = array.as_list_opt::<i32>() {
        return Some(list.values().clone());
    }
    if let Some(list) = array.as_list_opt::<i64>() {
        return Some(list.values().clone());
    }
    Some(array.as_fixed_size_list_opt()?.values().clone())
}
