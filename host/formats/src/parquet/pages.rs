//! The heads of the pages of a column, looked at before the crate `parquet` believes them: it reserves as many bytes, and as many values
//! of a dictionary, as a head says.

use super::file::damaged;
use super::thrift::{Thrift, kind};
use crate::error::FormatFault;
use ::parquet::basic::Type;
use ::parquet::file::metadata::ColumnChunkMetaData;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};

/// Bytes that are read to find a head, first; heads hold values as well, some of them long texts.
const HEAD: u64 = 1 << 12;
/// And at most.
const LONGEST_HEAD: u64 = 1 << 22;
/// Bytes of a page that are never too many: footers of some writers say less than there is.
const USUAL: u64 = 16 << 20;

/// What the head of a page says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Head {
    /// Its own bytes.
    length: u64,
    /// Bytes of the page as it is in the file.
    packed: i64,
    /// Bytes once it is unpacked.
    plain: i64,
    /// Values, by the field that says it.
    data: i64,
    dictionary: i64,
}

impl Head {
    fn of(bytes: &[u8]) -> Option<Self> {
        let mut thrift = Thrift { rest: bytes };
        let mut head = Head::default();
        let (mut field, mut is_page) = (0, false);
        while let Some(kind) = thrift.field(&mut field)? {
            match (field, kind) {
                (2, kind::I32) => head.plain = thrift.number()?,
                (3, kind::I32) => {
                    head.packed = thrift.number()?;
                    is_page = true;
                }
                (5 | 8, kind::STRUCT) => head.data = values(&mut thrift)?,
                (7, kind::STRUCT) => head.dictionary = values(&mut thrift)?,
                _ => thrift.skip(kind, 0)?,
            }
        }
        head.length = (bytes.len() - thrift.rest.len()) as u64;
        is_page.then_some(head)
    }
}

/// How many values a page has: the first field of what is said of its kind.
fn values(thrift: &mut Thrift<'_>) -> Option<i64> {
    let (mut field, mut values) = (0, 0);
    while let Some(kind) = thrift.field(&mut field)? {
        if field == 1 && kind == kind::I32 {
            values = thrift.number()?;
        } else {
            thrift.skip(kind, 1)?;
        }
    }
    Some(values)
}

/// Refuses a column of a row group of which a page claims more than there can be, or has no head that can be read while values are still
/// missing: the crate skips a list of a thousand million entries one by one, though the file has ended. What stands behind the last value is
/// never read.
pub(super) fn check(file: &mut File, chunk: &ColumnChunkMetaData) -> Result<(), FormatFault> {
    let start = chunk
        .dictionary_page_offset()
        .unwrap_or(chunk.data_page_offset());
    let (Ok(mut at), Ok(length)) = (u64::try_from(start), u64::try_from(chunk.compressed_size()))
    else {
        return Ok(());
    };
    let end = at.saturating_add(length);
    let mut missing = chunk.num_values();
    while at < end && missing > 0 {
        let Some(head) = head(file, at, end - at)? else {
            let name = chunk.column_path().string();
            return Err(damaged(format!(
                "a page of the column {name} has no head that can be read"
            )));
        };
        refuse(&head, chunk)?;
        missing = missing.saturating_sub(head.data);
        let Ok(packed) = u64::try_from(head.packed) else {
            return Ok(());
        };
        at = at.saturating_add(head.length).saturating_add(packed);
    }
    Ok(())
}

fn head(file: &mut File, at: u64, left: u64) -> Result<Option<Head>, FormatFault> {
    let mut window = HEAD;
    loop {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(at))?;
        (&mut *file)
            .take(window.min(left))
            .read_to_end(&mut bytes)?;
        let head = Head::of(&bytes);
        if head.is_some() || (bytes.len() as u64) < window || window >= LONGEST_HEAD {
            return Ok(head);
        }
        window *= 32;
    }
}

fn refuse(head: &Head, chunk: &ColumnChunkMetaData) -> Result<(), FormatFault> {
    let most = u64::try_from(chunk.uncompressed_size())
        .unwrap_or(0)
        .max(USUAL);
    let plain = u64::try_from(head.plain).unwrap_or(0);
    let least = match chunk.column_type() {
        Type::BOOLEAN => 1,
        Type::INT32 | Type::FLOAT | Type::BYTE_ARRAY => 4,
        Type::INT64 | Type::DOUBLE => 8,
        Type::INT96 => 12,
        Type::FIXED_LEN_BYTE_ARRAY => chunk.column_descr().type_length().max(1),
    };
    let all = [head.packed, head.plain, head.data, head.dictionary];
    let fits = all
        .iter()
        .all(|number| (0..=i64::from(i32::MAX)).contains(number))
        && plain <= most
        && head.dictionary.saturating_mul(i64::from(least)) <= head.plain
        && head.data <= chunk.num_values();
    if fits {
        return Ok(());
    }
    let name = chunk.column_path().string();
    Err(damaged(format!(
        "a page of the column {name} claims more than it has"
    )))
}

#[cfg(test)]
mod tests {
    use super::Head;

    #[test]
    fn heads_are_read_as_they_are_written() {
        // A dictionary of 3 values in 24 bytes, packed to 20; then the page itself.
        let dictionary = b"\x15\x04\x15\x30\x15\x28\x4c\x15\x06\x15\x00\x00\x00page";
        let head = Head::of(dictionary).expect("a head");
        let expected = Head {
            length: 13,
            packed: 20,
            plain: 24,
            data: 0,
            dictionary: 3,
        };
        assert_eq!(head, expected);
        for end in 0..13 {
            assert_eq!(Head::of(&dictionary[..end]), None, "{end}");
        }
    }
}
