//! Numbers of a data log.

use crate::bytes::Bytes;
use crate::log::Kind;

/// A number in a packed structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    Bool,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
    F32,
    F64,
}

impl Number {
    /// The type that is called so.
    pub(super) fn named(name: &str) -> Option<Self> {
        Some(match name {
            "bool" => Number::Bool,
            "int8" => Number::I8,
            "int16" => Number::I16,
            "int32" => Number::I32,
            "int64" => Number::I64,
            "uint8" => Number::U8,
            "uint16" => Number::U16,
            "uint32" => Number::U32,
            "uint64" => Number::U64,
            "float" | "float32" => Number::F32,
            "double" | "float64" => Number::F64,
            _ => return None,
        })
    }

    /// Its bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Number::Bool | Number::I8 | Number::U8 => 1,
            Number::I16 | Number::U16 => 2,
            Number::I32 | Number::U32 | Number::F32 => 4,
            Number::I64 | Number::U64 | Number::F64 => 8,
        }
    }

    /// What a column of it holds.
    pub(super) fn kind(self) -> Kind {
        if self == Number::Bool {
            Kind::Flag
        } else {
            Kind::Number
        }
    }

    /// The number at the front of these bytes.
    pub(super) fn read(self, bytes: &mut Bytes<'_>) -> Option<f64> {
        Some(match self {
            Number::Bool => f64::from(u8::from(bytes.u8()? != 0)),
            Number::U8 => f64::from(bytes.u8()?),
            Number::I8 => f64::from(bytes.u8()?.cast_signed()),
            Number::U16 => f64::from(bytes.u16()?),
            Number::I16 => f64::from(bytes.u16()?.cast_signed()),
            Number::U32 => f64::from(bytes.u32()?),
            Number::I32 => f64::from(bytes.u32()?.cast_signed()),
            Number::U64 => bytes.u64()? as f64,
            Number::I64 => bytes.u64()?.cast_signed() as f64,
            Number::F32 => f64::from(f32::from_bits(bytes.u32()?)),
            Number::F64 => f64::from_bits(bytes.u64()?),
        })
    }
}
