//! The values of decoded columns as numbers.

use super::columns::Step;
use crate::batch::Start;
use arrow_array::cast::AsArray;
use arrow_array::types::{Float64Type, Int64Type};
use arrow_array::{Array, ArrayRef, UInt64Array};
use arrow_cast::cast;
use arrow_schema::{ArrowError, DataType, TimeUnit};
use arrow_select::take::take;

/// What `steps` lead to in each row, as numbers.
pub(crate) fn numbers(
    array: &ArrayRef,
    steps: &[Step],
    start: &mut Start,
) -> Result<Vec<f64>, ArrowError> {
    let mut array = array.clone();
    for step in steps {
        array = match *step {
            Step::Field(at) => field(&array, at)?,
            Step::Element(at) => element(&array, at)?,
        };
    }
    leaf(&array, start)
}

/// The values of an array without lists and structures.
pub(crate) fn leaf(array: &ArrayRef, start: &mut Start) -> Result<Vec<f64>, ArrowError> {
    match array.data_type() {
        DataType::Dictionary(_, values) => leaf(&cast(array, values)?, start),
        DataType::Timestamp(unit, _) => times(array, per_second(unit), start),
        DataType::Date32 | DataType::Date64 => {
            let unit = TimeUnit::Millisecond;
            let array = cast(array, &DataType::Timestamp(unit, None))?;
            times(&array, per_second(&unit), start)
        }
        DataType::Time32(_) | DataType::Time64(_) => {
            let unit = TimeUnit::Nanosecond;
            times(
                &cast(array, &DataType::Time64(unit))?,
                per_second(&unit),
                start,
            )
        }
        DataType::Duration(unit) => {
            let array = cast(array, &DataType::Int64)?;
            let ticks = array.as_primitive::<Int64Type>();
            let seconds = |ticks: Option<i64>| {
                ticks.map_or(f64::NAN, |ticks| ticks as f64 / per_second(unit))
            };
            Ok(ticks.iter().map(seconds).collect())
        }
        DataType::Float64 => Ok(plain(array)),
        _ => Ok(plain(&cast(array, &DataType::Float64)?)),
    }
}

fn plain(array: &ArrayRef) -> Vec<f64> {
    let numbers = array.as_primitive_opt::<Float64Type>();
    let numbers = numbers.into_iter().flatten();
    numbers.map(|number| number.unwrap_or(f64::NAN)).collect()
}

fn times(array: &ArrayRef, per_second: f64, start: &mut Start) -> Result<Vec<f64>, ArrowError> {
    let array = cast(array, &DataType::Int64)?;
    let ticks = array.as_primitive_opt::<Int64Type>().into_iter().flatten();
    let mut since = |ticks: i64| start.since(i128::from(ticks), per_second);
    Ok(ticks
        .map(|ticks| ticks.map_or(f64::NAN, &mut since))
        .collect())
}

fn per_second(unit: &TimeUnit) -> f64 {
    match unit {
        TimeUnit::Second => 1.0,
        TimeUnit::Millisecond => 1e3,
        TimeUnit::Microsecond => 1e6,
        TimeUnit::Nanosecond => 1e9,
    }
}

fn field(array: &ArrayRef, at: usize) -> Result<ArrayRef, ArrowError> {
    let parts = array.as_struct_opt();
    let Some((parts, part)) = parts.and_then(|parts| Some((parts, parts.columns().get(at)?)))
    else {
        return Err(unlike(array));
    };
    if parts.null_count() == 0 {
        return Ok(part.clone());
    }
    // A part may hold anything where the whole is null.
    chosen(
        part,
        (0..parts.len()).map(|row| parts.is_valid(row).then_some(row)),
    )
}

fn element(array: &ArrayRef, at: usize) -> Result<ArrayRef, ArrowError> {
    let rows = 0..array.len();
    if let Some(lists) = array.as_list_opt::<i32>() {
        let offsets = lists.value_offsets();
        let found = |row| within(offsets.get(row..)?, at).filter(|_| lists.is_valid(row));
        return chosen(lists.values(), rows.map(found));
    }
    if let Some(lists) = array.as_list_opt::<i64>() {
        let offsets = lists.value_offsets();
        let found = |row| within(offsets.get(row..)?, at).filter(|_| lists.is_valid(row));
        return chosen(lists.values(), rows.map(found));
    }
    let Some(lists) = array.as_fixed_size_list_opt() else {
        return Err(unlike(array));
    };
    let found = |row| {
        let first = lists.value_offset_at(row);
        first.checked_add(at).filter(|_| lists.is_valid(row))
    };
    chosen(lists.values(), rows.map(found))
}

/// The index of the element `at` of the list that begins at the first of these offsets and ends at the second.
fn within<T: Copy + TryInto<usize>>(offsets: &[T], at: usize) -> Option<usize> {
    let &[first, end, ..] = offsets else {
        return None;
    };
    let index = first.try_into().ok()?.checked_add(at)?;
    (index < end.try_into().ok()?).then_some(index)
}

fn chosen(
    array: &ArrayRef,
    indices: impl Iterator<Item = Option<usize>>,
) -> Result<ArrayRef, ArrowError> {
    let inside = |index: &usize| *index < array.len();
    let indices: UInt64Array = indices
        .map(|index| index.filter(inside).map(|index| index as u64))
        .collect();
    take(array, &indices, None)
}

/// The file's pages are not of the type that its schema says.
fn unlike(array: &ArrayRef) -> ArrowError {
    ArrowError::SchemaError(format!("a column holds {}", array.data_type()))
}
