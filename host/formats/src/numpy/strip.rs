//! Columns of an array as bytes: where the values of one begin, and how far apart they are.

use super::dtype::Scalar;
use super::header::Header;
use crate::error::FormatFault;
use crate::log::Column;
use crate::plan::{Along, Plan, Source};
use crate::together::{self, Array};

/// The values of one column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Strip {
    /// The byte of the array's data at which the column, or the row of all columns, begins.
    pub(crate) start: u64,
    /// The byte within a row.
    pub(crate) within: u64,
    /// Bytes from row to row.
    pub(crate) stride: u64,
    /// Bytes of a value.
    pub(crate) bytes: u64,
    /// How a value is written.
    pub(crate) scalar: Scalar,
}

/// The column that `source` names; `None` where the array has none such.
pub(crate) fn strip(header: &Header, source: &Source) -> Option<Strip> {
    let dtype = &header.dtype;
    let Some(plain) = dtype.plain() else {
        let field = dtype.fields.get(usize::try_from(source.column).ok()?)?;
        return Some(Strip {
            start: 0,
            within: field.offset,
            stride: dtype.bytes,
            bytes: field.bytes,
            scalar: field.scalar,
        });
    };
    let [rows, columns] = together::shape(&header.axes)?;
    // The axis that is time is either the one whose neighbours are neighbours in the file, and a
    // column is one piece; or rows follow each other as a whole.
    let (is_one_piece, length, width) = match (source.along, header.is_fortran) {
        (Along::First, true) => (true, rows, columns),
        (Along::Second, false) => (true, columns, rows),
        (Along::First, false) => (columns == 1, rows, columns),
        (Along::Second, true) => (rows == 1, columns, rows),
    };
    let unit = if is_one_piece { length } else { 1 };
    let place = source.column.checked_mul(unit)?.checked_mul(dtype.bytes)?;
    Some(Strip {
        start: if is_one_piece { place } else { 0 },
        within: if is_one_piece { 0 } else { place },
        stride: dtype.bytes * if is_one_piece { 1 } else { width },
        bytes: dtype.bytes,
        scalar: plain.scalar,
    })
}

/// The tables of arrays with names; structured ones have one of their own.
pub(crate) fn plan(arrays: &[(String, Header)]) -> Result<Plan, FormatFault> {
    let mut plan = Plan::default();
    let plain = arrays
        .iter()
        .enumerate()
        .filter_map(|(id, (name, header))| {
            Some(Array {
                name: name.clone(),
                shape: together::shape(&header.axes)?,
                kind: header.dtype.plain()?.kind(),
                unit: None,
                id,
            })
        });
    together::add(&mut plan, "", ".", plain.collect())?;
    for (id, (name, header)) in arrays.iter().enumerate() {
        match together::shape(&header.axes) {
            None => plan.unread(
                name,
                format!("an array with the axes {:?}", header.axes),
                "reshape it to two axes, `x.reshape(len(x), -1)`",
            ),
            Some(_) if header.dtype.plain().is_some() => {}
            Some([rows, 1]) => structured(&mut plan, name, header, rows, id)?,
            Some([rows, columns]) => plan.unread(
                name,
                format!("an array of {rows} x {columns} structures"),
                "save each of its columns as an array",
            ),
        }
    }
    Ok(plan)
}

fn structured(
    plan: &mut Plan,
    name: &str,
    header: &Header,
    rows: u64,
    id: usize,
) -> Result<(), FormatFault> {
    let fields = header.dtype.fields.iter().zip(0..);
    // Bytes that align the others have no name.
    let named = fields.filter(|(field, _)| !field.name.is_empty());
    let columns = named.map(|(field, column)| {
        let kind = field.kind();
        let shown = Column {
            name: field.name.clone(),
            kind,
            unit: None,
        };
        let source = Source {
            array: id,
            column,
            along: Along::First,
            kind,
        };
        (shown, source)
    });
    plan.table(name, rows, columns.collect())
}
