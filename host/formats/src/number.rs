//! Numbers as bytes.

use half::f16;

/// How a number is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number {
    /// What kind of number.
    pub(crate) class: Class,
    /// Whether its first byte is the most significant one.
    pub(crate) big: bool,
}

/// Kinds of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// Signed, 1 byte.
    I8,
    /// Signed, 2 bytes.
    I16,
    /// Signed, 4 bytes.
    I32,
    /// Signed, 8 bytes.
    I64,
    /// Unsigned, 1 byte.
    U8,
    /// Unsigned, 2 bytes.
    U16,
    /// Unsigned, 4 bytes.
    U32,
    /// Unsigned, 8 bytes.
    U64,
    /// Floating point, 2 bytes.
    F16,
    /// Floating point, 4 bytes.
    F32,
    /// Floating point, 8 bytes.
    F64,
}

impl Class {
    /// The integer of so many bytes.
    pub(crate) fn integer(bytes: u64, signed: bool) -> Option<Self> {
        Some(match (bytes, signed) {
            (1, true) => Class::I8,
            (2, true) => Class::I16,
            (4, true) => Class::I32,
            (8, true) => Class::I64,
            (1, false) => Class::U8,
            (2, false) => Class::U16,
            (4, false) => Class::U32,
            (8, false) => Class::U64,
            _ => return None,
        })
    }

    /// The floating-point number of so many bytes.
    pub(crate) fn float(bytes: u64) -> Option<Self> {
        Some(match bytes {
            2 => Class::F16,
            4 => Class::F32,
            8 => Class::F64,
            _ => return None,
        })
    }

    /// Its bytes.
    pub(crate) fn bytes(self) -> usize {
        match self {
            Class::I8 | Class::U8 => 1,
            Class::I16 | Class::U16 | Class::F16 => 2,
            Class::I32 | Class::U32 | Class::F32 => 4,
            Class::I64 | Class::U64 | Class::F64 => 8,
        }
    }
}

impl Number {
    /// Its value; NaN where `bytes` are not as many as it has.
    pub(crate) fn value(self, bytes: &[u8]) -> f64 {
        macro_rules! value {
            ($($class:ident: $kind:ty),*) => {
                match self.class {
                    $(Class::$class => match <[u8; size_of::<$kind>()]>::try_from(bytes) {
                        Ok(bytes) if self.big => <$kind>::from_be_bytes(bytes).into_f64(),
                        Ok(bytes) => <$kind>::from_le_bytes(bytes).into_f64(),
                        Err(_) => f64::NAN,
                    },)*
                }
            };
        }
        value!(I8: i8, I16: i16, I32: i32, I64: i64, U8: u8, U16: u16, U32: u32, U64: u64,
            F16: f16, F32: f32, F64: f64)
    }
}

/// The nearest number of 64 bits.
trait IntoF64 {
    fn into_f64(self) -> f64;
}

macro_rules! into_f64 {
    ($($kind:ty),*) => {
        $(impl IntoF64 for $kind {
            fn into_f64(self) -> f64 {
                self as f64
            }
        })*
    };
}
into_f64!(i8, i16, i32, i64, u8, u16, u32, u64, f32, f64);

impl IntoF64 for f16 {
    fn into_f64(self) -> f64 {
        self.to_f64()
    }
}
