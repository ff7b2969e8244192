//! Elements of datasets as numbers.

use crate::log::{Column, Kind};
use crate::number::{Class, Number};
use crate::plan::MOST_COLUMNS;
use hdf5_reader::error::{ByteOrder, Error, Result};
use hdf5_reader::{Datatype, H5Type, dtype_element_size};

/// What the names of a flag's values are for h5py.
const FLAG: [&str; 2] = ["FALSE", "TRUE"];

/// How a number is written, and what it is; `None` for what is no number.
pub(crate) fn number(datatype: &Datatype) -> Option<(Number, Kind)> {
    let number = |class: Option<Class>, order: &ByteOrder| {
        class.map(|class| Number {
            class,
            big: *order == ByteOrder::BigEndian,
        })
    };
    match datatype {
        Datatype::FixedPoint {
            size,
            signed,
            byte_order,
        } => {
            let class = Class::integer(u64::from(*size), *signed);
            Some((number(class, byte_order)?, Kind::Number))
        }
        Datatype::FloatingPoint { size, byte_order } => {
            let class = Class::float(u64::from(*size));
            Some((number(class, byte_order)?, Kind::Number))
        }
        Datatype::Bitfield { size, byte_order } => {
            let class = Class::integer(u64::from(*size), false);
            Some((number(class, byte_order)?, Kind::Number))
        }
        Datatype::Enum { base, members } => {
            let (number, _) = self::number(base)?;
            let is_flag = members.iter().map(|member| &*member.name).eq(FLAG);
            Some((number, if is_flag { Kind::Flag } else { Kind::Number }))
        }
        _ => None,
    }
}

/// One number of a dataset of numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Single(pub(crate) f64);

impl H5Type for Single {
    fn hdf5_type() -> Datatype {
        f64::hdf5_type()
    }

    fn from_bytes(bytes: &[u8], datatype: &Datatype) -> Result<Self> {
        let (number, _) = number(datatype).ok_or_else(|| mismatch("a number", datatype))?;
        Ok(Single(number.value(bytes)))
    }

    fn element_size(datatype: &Datatype) -> usize {
        dtype_element_size(datatype).unwrap_or(0)
    }
}

/// One record of a dataset of records, as its bytes.
#[derive(Clone, Debug)]
pub(crate) struct Record(pub(crate) Box<[u8]>);

impl H5Type for Record {
    fn hdf5_type() -> Datatype {
        Datatype::Opaque {
            size: 0,
            tag: String::new(),
        }
    }

    fn from_bytes(bytes: &[u8], _: &Datatype) -> Result<Self> {
        Ok(Record(bytes.into()))
    }

    fn element_size(datatype: &Datatype) -> usize {
        dtype_element_size(datatype).unwrap_or(0)
    }
}

fn mismatch(expected: &str, actual: &Datatype) -> Error {
    Error::TypeMismatch {
        expected: expected.to_owned(),
        actual: format!("{actual:?}"),
    }
}

/// A value of a record.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    offset: usize,
    number: Number,
}

impl Field {
    /// Its value in a record.
    pub(crate) fn value(&self, record: &Record) -> f64 {
        let end = self.offset.saturating_add(self.number.class.bytes());
        let bytes = record.0.get(self.offset..end);
        self.number.value(bytes.unwrap_or(&[]))
    }
}

/// The columns of records, with where each is; a column that is no number is none of these.
pub(crate) fn fields(datatype: &Datatype) -> Vec<(Column, Option<Field>)> {
    let mut columns = Vec::new();
    add("", 0, datatype, &mut columns);
    columns
}

fn add(name: &str, offset: usize, datatype: &Datatype, to: &mut Vec<(Column, Option<Field>)>) {
    if to.len() as u64 >= MOST_COLUMNS {
        return;
    }
    match datatype {
        Datatype::Compound { fields, .. } => {
            for field in fields {
                let offset = offset.saturating_add(field.byte_offset as usize);
                let name = crate::plan::join(name, ".", &field.name);
                add(&name, offset, &field.datatype, to);
            }
        }
        Datatype::Array { base, dims } => {
            let size = dtype_element_size(base).unwrap_or(0);
            let elements = dims
                .iter()
                .try_fold(1_u64, |all, &dim| all.checked_mul(dim));
            for at in 0..elements.unwrap_or(0).min(MOST_COLUMNS) {
                let offset = offset.saturating_add(size.saturating_mul(at as usize));
                add(&format!("{name}[{at}]"), offset, base, to);
            }
        }
        single => {
            let number = number(single);
            let column = Column {
                name: name.to_owned(),
                kind: number.map_or(Kind::Text, |(_, kind)| kind),
                unit: None,
            };
            to.push((column, number.map(|(number, _)| Field { offset, number })));
        }
    }
}
