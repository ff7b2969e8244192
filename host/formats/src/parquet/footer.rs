//! The footer of a Parquet file, looked at before the crate `parquet` reads it: a schema of thousands of levels would end its stack.

use super::thrift::{Thrift, kind};
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
