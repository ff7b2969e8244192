//! The values of decoded columns as numbers.

use super::columns::Step;
use crate::batch::Start;
use arrow_array::cast::AsArray;
use arrow_array::types::{
    ArrowPrimitiveType, Date32Type, Date64Type, Decimal32Type, Decimal64Type, Decimal128Type,
    Decimal256Type, DurationMicrosecondType, DurationMillisecondType, DurationNanosecondType,
    DurationSecondType, Float16Type, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type,
    Int64Type, Time32MillisecondType, Time32SecondType, Time64MicrosecondType,
    Time64NanosecondType, TimestampMicrosecondType, TimestampMillisecondType,
    TimestampNanosecondType, TimestampSecondType, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{Array, ArrayRef, UInt64Array};
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

/// The values of an array without lists and structures. The types are few, so that the kernels of `arrow-cast`, which convert each type into each
/// other one, would be most of what a build takes.
pub(crate) fn leaf(array: &ArrayRef, start: &mut Start) -> Result<Vec<f64>, ArrowError> {
    match array.data_type() {
        DataType::Dictionary(..) => {
            let Some(dictionary) = array.as_any_dictionary_opt() else {
                return Err(unlike(array));
            };
            let keys = dictionary.normalized_keys().into_iter().enumerate();
            let places = keys.map(|(row, key)| dictionary.is_valid(row).then_some(key));
            leaf(&chosen(dictionary.values(), places)?, start)
        }
        DataType::Timestamp(unit, _) => {
            let ticks = match unit {
                TimeUnit::Second => ticks::<TimestampSecondType>(array),
                TimeUnit::Millisecond => ticks::<TimestampMillisecondType>(array),
                TimeUnit::Microsecond => ticks::<TimestampMicrosecondType>(array),
                TimeUnit::Nanosecond => ticks::<TimestampNanosecondType>(array),
            };
            Ok(times(ticks?, per_second(unit), start))
        }
        DataType::Date32 => {
            let days = ticks::<Date32Type>(array)?;
            Ok(times(days, 1.0 / SECONDS_A_DAY, start))
        }
        DataType::Date64 => Ok(times(ticks::<Date64Type>(array)?, 1e3, start)),
        DataType::Time32(unit) => {
            let ticks = match unit {
                TimeUnit::Second => ticks::<Time32SecondType>(array),
                _ => ticks::<Time32MillisecondType>(array),
            };
            Ok(times(ticks?, per_second(unit), start))
        }
        DataType::Time64(unit) => {
            let ticks = match unit {
                TimeUnit::Nanosecond => ticks::<Time64NanosecondType>(array),
                _ => ticks::<Time64MicrosecondType>(array),
            };
            Ok(times(ticks?, per_second(unit), start))
        }
        DataType::Duration(unit) => {
            let ticks = match unit {
                TimeUnit::Second => ticks::<DurationSecondType>(array),
                TimeUnit::Millisecond => ticks::<DurationMillisecondType>(array),
                TimeUnit::Microsecond => ticks::<DurationMicrosecondType>(array),
                TimeUnit::Nanosecond => ticks::<DurationNanosecondType>(array),
            };
            let seconds = |ticks: Option<i64>| {
                ticks.map_or(f64::NAN, |ticks| ticks as f64 / per_second(unit))
            };
            Ok(ticks?.into_iter().map(seconds).collect())
        }
        DataType::Boolean => {
            let flags = array.as_boolean_opt().ok_or_else(|| unlike(array))?;
            let number =
                |flag: Option<bool>| flag.map_or(f64::NAN, |flag| f64::from(u8::from(flag)));
            Ok(flags.iter().map(number).collect())
        }
        DataType::Int8 => numbers_of::<Int8Type>(array, f64::from),
        DataType::Int16 => numbers_of::<Int16Type>(array, f64::from),
        DataType::Int32 => numbers_of::<Int32Type>(array, f64::from),
        DataType::Int64 => numbers_of::<Int64Type>(array, |x| x as f64),
        DataType::UInt8 => numbers_of::<UInt8Type>(array, f64::from),
        DataType::UInt16 => numbers_of::<UInt16Type>(array, f64::from),
        DataType::UInt32 => numbers_of::<UInt32Type>(array, f64::from),
        DataType::UInt64 => numbers_of::<UInt64Type>(array, |x| x as f64),
        DataType::Float16 => numbers_of::<Float16Type>(array, f64::from),
        DataType::Float32 => numbers_of::<Float32Type>(array, f64::from),
        DataType::Float64 => numbers_of::<Float64Type>(array, |x| x),
        DataType::Decimal32(_, scale) => {
            numbers_of::<Decimal32Type>(array, |x| f64::from(x) / power(*scale))
        }
        DataType::Decimal64(_, scale) => {
            numbers_of::<Decimal64Type>(array, |x| x as f64 / power(*scale))
        }
        DataType::Decimal128(_, scale) => {
            numbers_of::<Decimal128Type>(array, |x| x as f64 / power(*scale))
        }
        DataType::Decimal256(_, scale) => numbers_of::<Decimal256Type>(array, |x| {
            x.to_i128().map_or(f64::NAN, |x| x as f64) / power(*scale)
        }),
        _ => Err(unlike(array)),
    }
}

const SECONDS_A_DAY: f64 = 86_400.0;

fn power(scale: i8) -> f64 {
    10f64.powi(i32::from(scale))
}

/// The numbers of an array of one type; NaN where it has none.
fn numbers_of<T: ArrowPrimitiveType>(
    array: &ArrayRef,
    number: impl Fn(T::Native) -> f64,
) -> Result<Vec<f64>, ArrowError> {
    let values = array.as_primitive_opt::<T>().ok_or_else(|| unlike(array))?;
    let values = values.iter().map(|value| value.map_or(f64::NAN, &number));
    Ok(values.collect())
}

/// The ticks of an array of times.
fn ticks<T: ArrowPrimitiveType>(array: &ArrayRef) -> Result<Vec<Option<i64>>, ArrowError>
where
    T::Native: Into<i64>,
{
    let values = array.as_primitive_opt::<T>().ok_or_else(|| unlike(array))?;
    Ok(values.iter().map(|value| value.map(Into::into)).collect())
}

fn times(ticks: Vec<Option<i64>>, per_second: f64, start: &mut Start) -> Vec<f64> {
    let mut since = |ticks: i64| start.since(i128::from(ticks), per_second);
    let seconds = |ticks: Option<i64>| ticks.map_or(f64::NAN, &mut since);
    ticks.into_iter().map(seconds).collect()
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
