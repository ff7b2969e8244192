//! What messages are made of, as bytes.
//!
//! | what | bytes |
//! |---|---|
//! | `bool`, `u8` | one |
//! | other whole numbers | seven bits a byte, lowest first, the eighth says that more follow (LEB128); signed ones in zigzag |
//! | `f32` | four, lowest first |
//! | an enum | its index as a whole number, then its fields |
//! | an option | 0, or 1 and the value |
//! | a list, a text | its length, then its elements |
//!
//! The wire format of postcard 1.0, whose traits cost an M0+ two kilobytes more. What goes wrong is remembered and asked for once
//! at the end: until then, what is not there reads as zero.

use heapless::{String, Vec};

/// Writes into a buffer.
pub struct Writer<'a> {
    buffer: &'a mut [u8],
    len: usize,
    full: bool,
}

impl<'a> Writer<'a> {
    /// At the buffer's start.
    pub fn new(buffer: &'a mut [u8]) -> Self {
        Writer {
            buffer,
            len: 0,
            full: false,
        }
    }

    /// Bytes written; none if they did not fit.
    pub fn finish(self) -> Option<usize> {
        (!self.full).then_some(self.len)
    }

    #[inline(never)]
    fn byte(&mut self, byte: u8) {
        match self.buffer.get_mut(self.len) {
            Some(slot) => {
                *slot = byte;
                self.len += 1;
            }
            None => self.full = true,
        }
    }

    #[inline(never)]
    fn number(&mut self, mut x: u32) {
        while x > 0x7f {
            self.byte(x as u8 | 0x80);
            x >>= 7;
        }
        self.byte(x as u8);
    }

    #[inline(never)]
    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.byte(byte);
        }
    }
}

/// Reads from bytes.
pub struct Reader<'a> {
    rest: &'a [u8],
    bad: bool,
}

impl<'a> Reader<'a> {
    /// From the start.
    pub fn new(bytes: &'a [u8]) -> Self {
        Reader {
            rest: bytes,
            bad: false,
        }
    }

    /// What was read, if all of it was there and made sense. Bytes that are left over are a newer peer's.
    pub fn finish<T>(self, read: T) -> Option<T> {
        (!self.bad).then_some(read)
    }

    #[inline(never)]
    fn byte(&mut self) -> u8 {
        match self.rest.split_first() {
            Some((&byte, rest)) => {
                self.rest = rest;
                byte
            }
            None => {
                self.bad = true;
                0
            }
        }
    }

    /// A whole number of at most so many bits.
    #[inline(never)]
    fn long(&mut self, bits: u32) -> u64 {
        let mut x = 0;
        for shift in (0..bits).step_by(7) {
            let byte = self.byte();
            let part = u64::from(byte & 0x7f);
            if part >> (bits - shift).min(7) != 0 {
                break;
            }
            x |= part << shift;
            if byte < 0x80 {
                return x;
            }
        }
        self.bad = true;
        0
    }

    fn number(&mut self, bits: u32) -> u32 {
        self.long(bits) as u32
    }

    /// The index of one of so many, the first if it is none of them.
    #[inline(never)]
    pub fn index(&mut self, of: u32) -> u32 {
        let index = self.number(32);
        if index < of {
            index
        } else {
            self.bad = true;
            0
        }
    }
}

/// What has a form as bytes.
pub trait Coded: Sized {
    /// Writes it.
    fn put(&self, to: &mut Writer<'_>);
    /// Reads it; says something harmless if it is not there.
    fn take(from: &mut Reader<'_>) -> Self;
}

impl Coded for u8 {
    fn put(&self, to: &mut Writer<'_>) {
        to.byte(*self);
    }
    fn take(from: &mut Reader<'_>) -> Self {
        from.byte()
    }
}

impl Coded for bool {
    fn put(&self, to: &mut Writer<'_>) {
        to.byte((*self).into());
    }
    fn take(from: &mut Reader<'_>) -> Self {
        from.index(2) == 1
    }
}

impl Coded for u16 {
    fn put(&self, to: &mut Writer<'_>) {
        to.number((*self).into());
    }
    fn take(from: &mut Reader<'_>) -> Self {
        from.number(16) as u16
    }
}

impl Coded for u32 {
    fn put(&self, to: &mut Writer<'_>) {
        to.number(*self);
    }
    fn take(from: &mut Reader<'_>) -> Self {
        from.number(32)
    }
}

impl Coded for u64 {
    fn put(&self, to: &mut Writer<'_>) {
        let mut x = *self;
        while x > 0x7f {
            to.byte(x as u8 | 0x80);
            x >>= 7;
        }
        to.byte(x as u8);
    }
    fn take(from: &mut Reader<'_>) -> Self {
        from.long(64)
    }
}

impl Coded for i16 {
    fn put(&self, to: &mut Writer<'_>) {
        // Of the same size or shorter: zigzag leaves the upper half of a small number empty.
        i32::from(*self).put(to);
    }
    fn take(from: &mut Reader<'_>) -> Self {
        unfolded(from.number(16)) as i16
    }
}

impl Coded for i32 {
    #[inline(never)]
    fn put(&self, to: &mut Writer<'_>) {
        to.number(((*self << 1) ^ (*self >> 31)).cast_unsigned());
    }
    fn take(from: &mut Reader<'_>) -> Self {
        unfolded(from.number(32))
    }
}

/// Out of the zigzag 0, −1, 1, −2, …
fn unfolded(x: u32) -> i32 {
    ((x >> 1) ^ (x & 1).wrapping_neg()).cast_signed()
}

impl Coded for f32 {
    #[inline(never)]
    fn put(&self, to: &mut Writer<'_>) {
        to.bytes(&self.to_le_bytes());
    }
    fn take(from: &mut Reader<'_>) -> Self {
        f32::from_le_bytes(core::array::from_fn(|_| from.byte()))
    }
}

impl<T: Coded> Coded for Option<T> {
    fn put(&self, to: &mut Writer<'_>) {
        to.byte(self.is_some().into());
        if let Some(value) = self {
            value.put(to);
        }
    }
    fn take(from: &mut Reader<'_>) -> Self {
        bool::take(from).then(|| T::take(from))
    }
}

impl<T: Coded, const N: usize> Coded for Vec<T, N> {
    fn put(&self, to: &mut Writer<'_>) {
        to.number(self.len() as u32);
        for element in self {
            element.put(to);
        }
    }
    fn take(from: &mut Reader<'_>) -> Self {
        let mut list = Vec::new();
        for _ in 0..from.index(N as u32 + 1) {
            // There is room for all.
            let _ = list.push(T::take(from));
        }
        list
    }
}

impl<const N: usize> Coded for String<N> {
    fn put(&self, to: &mut Writer<'_>) {
        to.number(self.len() as u32);
        to.bytes(self.as_bytes());
    }
    fn take(from: &mut Reader<'_>) -> Self {
        let text = String::from_utf8(Vec::take(from));
        from.bad |= text.is_err();
        text.unwrap_or_default()
    }
}

/// The form of a struct: its fields in this order. Of an enum without fields: its index.
macro_rules! coded {
    (struct $name:ident { $($field:ident),* $(,)? }) => {
        impl $crate::wire::Coded for $name {
            fn put(&self, to: &mut $crate::wire::Writer<'_>) {
                let $name { $($field),* } = self;
                $($crate::wire::Coded::put($field, to);)*
            }
            fn take(from: &mut $crate::wire::Reader<'_>) -> Self {
                $name { $($field: $crate::wire::Coded::take(from)),* }
            }
        }
    };
    (enum $name:ident { $($variant:ident),* $(,)? }) => {
        impl $name {
            /// All of them, in the order of the wire.
            pub const ALL: [Self; [$(stringify!($variant)),*].len()] = [$($name::$variant),*];
        }
        impl $crate::wire::Coded for $name {
            fn put(&self, to: &mut $crate::wire::Writer<'_>) {
                $crate::wire::Coded::put(&(*self as u32), to);
            }
            fn take(from: &mut $crate::wire::Reader<'_>) -> Self {
                let at = from.index(Self::ALL.len() as u32) as usize;
                *Self::ALL.get(at).unwrap_or(&Self::ALL[0])
            }
        }
    };
}
pub(crate) use coded;

#[cfg(test)]
mod tests {
    use super::*;

    fn written<T: Coded>(x: &T) -> std::vec::Vec<u8> {
        let mut buffer = [0; 32];
        let mut to = Writer::new(&mut buffer);
        x.put(&mut to);
        let len = to.finish().expect("it fits");
        buffer[..len].to_vec()
    }

    fn read<T: Coded>(bytes: &[u8]) -> Option<T> {
        let mut from = Reader::new(bytes);
        let x = T::take(&mut from);
        from.finish(x)
    }

    #[test]
    fn numbers_take_the_bytes_that_they_need_and_come_back() {
        for (x, bytes) in [
            (0, &[0][..]),
            (127, &[127]),
            (128, &[0x80, 1]),
            (
                u64::MAX,
                &[0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1],
            ),
        ] {
            assert_eq!(written(&x), bytes);
            assert_eq!(read(bytes), Some(x));
        }
        assert_eq!(written(&u32::MAX), [0xff, 0xff, 0xff, 0xff, 0x0f]);
        assert_eq!(written(&-1i16), [1]);
        assert_eq!(written(&i16::MIN), [0xff, 0xff, 3]);
        for x in [0, 1, -1, 63, -64, 64, i16::MAX, i16::MIN] {
            assert_eq!(read(&written(&x)), Some(x));
            assert_eq!(read(&written(&i32::from(x))), Some(i32::from(x)));
        }
        for x in [i32::MAX, i32::MIN] {
            assert_eq!(read(&written(&x)), Some(x));
        }
    }

    #[test]
    fn what_is_too_large_cut_off_or_no_such_thing_is_refused() {
        assert_eq!(read::<u16>(&[0xff, 0xff, 3]), Some(u16::MAX));
        assert_eq!(read::<u16>(&[0xff, 0xff, 4]), None);
        assert_eq!(read::<u16>(&[0x80, 0x80, 0x80, 0]), None);
        assert_eq!(read::<u32>(&[0xff, 0xff, 0xff, 0xff, 0x10]), None);
        assert_eq!(read::<u64>(&[0xff; 10]), None);
        assert_eq!(read::<u32>(&[0x80]), None);
        assert_eq!(read::<f32>(&[0, 0, 0]), None);
        assert_eq!(read::<bool>(&[2]), None);
        assert_eq!(read::<Option<u8>>(&[2, 0]), None);
        assert_eq!(read::<Vec<u8, 2>>(&[3, 1, 2, 3]), None);
        assert_eq!(read::<String<4>>(&[2, 0xff, 0xff]), None);
        let mut short = [0; 2];
        let mut to = Writer::new(&mut short);
        u32::MAX.put(&mut to);
        assert_eq!(to.finish(), None);
    }
}
