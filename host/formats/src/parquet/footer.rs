//! The footer of a Parquet file, looked at before the crate `parquet` reads it: a schema of thousands of levels would end its stack.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};

/// First bytes of a Parquet file, and its last.
pub(crate) const MAGIC: &[u8; 4] = b"PAR1";

/// Levels of a schema.
const DEEPEST: usize = 64;
/// The footer's length and the magic after it.
const END: u64 = 8;

/// What the end of a file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Footer {
    /// A schema that may be read.
    Usable,
    /// There is none: the file was cut short.
    Missing,
    /// It is encrypted.
    Encrypted,
    /// It is none, or has more levels than any table has.
    Damaged,
}

impl Footer {
    /// Looks at the end of a file.
    pub(super) fn of(file: &mut File) -> io::Result<Self> {
        let length = file.seek(SeekFrom::End(0))?;
        let Some(from) = length.checked_sub(END) else {
            return Ok(Footer::Missing);
        };
        let mut end = Vec::new();
        file.seek(SeekFrom::Start(from))?;
        file.read_to_end(&mut end)?;
        match end.split_first_chunk::<4>() {
            Some((_, b"PARE")) => Ok(Footer::Encrypted),
            Some((footer, magic)) if magic == MAGIC => {
                let footer = u64::from(u32::from_le_bytes(*footer));
                let Some(start) = from.checked_sub(footer) else {
                    return Ok(Footer::Damaged);
                };
                let mut content = Vec::new();
                file.seek(SeekFrom::Start(start))?;
                file.take(footer).read_to_end(&mut content)?;
                let is_flat = Thrift { rest: &content }.schema();
                Ok(is_flat.map_or(Footer::Damaged, |()| Footer::Usable))
            }
            _ => Ok(Footer::Missing),
        }
    }
}

/// Values in the compact protocol of Thrift, which footers are written in.
struct Thrift<'b> {
    rest: &'b [u8],
}

mod kind {
    pub(super) const TRUE: u8 = 1;
    pub(super) const FALSE: u8 = 2;
    pub(super) const BYTE: u8 = 3;
    pub(super) const I16: u8 = 4;
    pub(super) const I32: u8 = 5;
    pub(super) const I64: u8 = 6;
    pub(super) const DOUBLE: u8 = 7;
    pub(super) const BINARY: u8 = 8;
    pub(super) const LIST: u8 = 9;
    pub(super) const SET: u8 = 10;
    pub(super) const MAP: u8 = 11;
    pub(super) const STRUCT: u8 = 12;
}

impl Thrift<'_> {
    /// Goes over the schema, which is the footer's second field; `None` if it is none, or is too deep.
    fn schema(&mut self) -> Option<()> {
        let mut field = 0;
        while let Some(kind) = self.field(&mut field)? {
            if field != 2 {
                self.skip(kind, 0)?;
                continue;
            }
            let (count, _) = self.list()?;
            // How many children are still to come on each level.
            let mut open: Vec<u64> = Vec::new();
            for _ in 0..count {
                while open.last() == Some(&0) {
                    open.pop();
                }
                if let Some(left) = open.last_mut() {
                    *left -= 1;
                }
                match self.children()? {
                    0 => {}
                    children => open.push(children),
                }
                if open.len() > DEEPEST {
                    return None;
                }
            }
            return Some(());
        }
        None
    }

    /// How many children an element of the schema has: its fifth field.
    fn children(&mut self) -> Option<u64> {
        let (mut field, mut children) = (0, 0);
        while let Some(kind) = self.field(&mut field)? {
            if field == 5 && kind == kind::I32 {
                // Signs are in the last bit.
                children = self.varint()? >> 1;
            } else {
                self.skip(kind, 0)?;
            }
        }
        Some(children)
    }

    /// The kind of the next field, whose number is counted on; `Some(None)` at the end of the structure.
    fn field(&mut self, number: &mut u64) -> Option<Option<u8>> {
        let head = self.byte()?;
        if head == 0 {
            return Some(None);
        }
        *number = match head >> 4 {
            0 => self.varint()? >> 1,
            step => number.checked_add(u64::from(step))?,
        };
        Some(Some(head & 15))
    }

    fn list(&mut self) -> Option<(u64, u8)> {
        let head = self.byte()?;
        let count = match head >> 4 {
            15 => self.varint()?,
            count => u64::from(count),
        };
        // Each element has a byte at least.
        (count <= self.rest.len() as u64).then_some((count, head & 15))
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        match kind {
            kind::TRUE | kind::FALSE => {}
            kind::BYTE => self.bytes(1)?,
            kind::I16 | kind::I32 | kind::I64 => {
                self.varint()?;
            }
            kind::DOUBLE => self.bytes(8)?,
            kind::BINARY => {
                let length = self.varint()?;
                self.bytes(length)?;
            }
            kind::LIST | kind::SET => {
                let (count, kind) = self.list()?;
                for _ in 0..count {
                    self.element(kind, depth)?;
                }
            }
            kind::MAP => {
                let count = self.varint()?;
                let kinds = if count == 0 { 0 } else { self.byte()? };
                for _ in 0..count {
                    self.element(kinds >> 4, depth)?;
                    self.element(kinds & 15, depth)?;
                }
            }
            kind::STRUCT => {
                let mut field = 0;
                while let Some(kind) = self.field(&mut field)? {
                    self.skip(kind, depth + 1)?;
                }
            }
            _ => return None,
        }
        Some(())
    }

    /// Goes over a value in a list, where a flag has a byte of its own.
    fn element(&mut self, kind: u8, depth: usize) -> Option<()> {
        match kind {
            kind::TRUE | kind::FALSE => self.bytes(1),
            kind => self.skip(kind, depth + 1),
        }
    }

    fn bytes(&mut self, count: u64) -> Option<()> {
        self.rest = self.rest.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(*first)
    }

    fn varint(&mut self) -> Option<u64> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{DEEPEST, Thrift};

    /// A footer of one column that many groups lie around.
    fn footer(groups: usize) -> Vec<u8> {
        let mut bytes = vec![0x15, 2, 0x19, 0xfc];
        let mut count = groups + 2;
        while count >= 0x80 {
            bytes.push((count & 0x7f) as u8 | 0x80);
            count >>= 7;
        }
        bytes.push(count as u8);
        bytes.extend(b"\x48\x01r\x15\x02\0");
        for _ in 0..groups {
            bytes.extend(b"\x35\0\x18\x01a\x15\x02\0");
        }
        bytes.extend(b"\x15\x0a\x25\0\x18\x01x\0\x16\0\x19\x0c\0");
        bytes
    }

    #[test]
    fn schemas_of_few_levels_are_read_and_others_are_not() {
        for (groups, is_flat) in [
            (0, true),
            (DEEPEST - 1, true),
            (DEEPEST, false),
            (9_999, false),
        ] {
            let found = Thrift {
                rest: &footer(groups),
            }
            .schema();
            assert_eq!(found.is_some(), is_flat, "{groups} groups");
        }
    }
}
