//! The header of a NumPy array.

use super::dtype::{Dtype, Untold};
use super::literal::Literal;
use crate::error::FormatError;
use crate::origin::Origin;
use crate::plan::MOST_COLUMNS;
use std::io::Read;

/// The first bytes of every array.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";
/// Bytes of a header: names of fields and little else.
const LONGEST: u32 = 1 << 20;

/// The header of a NumPy array.
#[derive(Clone, Debug)]
pub(crate) struct Header {
    /// What an element is made of.
    pub(crate) dtype: Dtype,
    /// The length along each axis.
    pub(crate) axes: Vec<u64>,
    /// Whether the first axis is the one that changes fastest in the file.
    pub(crate) is_fortran: bool,
    /// Bytes of the header, behind which the elements are.
    pub(crate) bytes: u64,
    /// Bytes of all elements.
    pub(crate) data: u64,
}

impl Header {
    /// Reads the header that `reader` begins with; `place` is the array's name for errors.
    pub(crate) fn read(
        origin: &Origin,
        place: &str,
        reader: &mut dyn Read,
    ) -> Result<Self, FormatError> {
        let failed = |error| origin.failed_read(place, "the header of an array", error);
        let mut start = [0; 8];
        reader.read_exact(&mut start).map_err(failed)?;
        if !start.starts_with(MAGIC) {
            return Err(origin.damaged(place, "an array does not begin as one of NumPy does"));
        }
        let [.., version, _] = start;
        let (length, bytes) = if version == 1 {
            let mut length = [0; 2];
            reader.read_exact(&mut length).map_err(failed)?;
            (u32::from(u16::from_le_bytes(length)), 10)
        } else {
            let mut length = [0; 4];
            reader.read_exact(&mut length).map_err(failed)?;
            (u32::from_le_bytes(length), 12)
        };
        if length > LONGEST {
            return Err(origin.damaged(place, format!("its header has {length} bytes")));
        }
        let mut text = Vec::new();
        reader
            .take(u64::from(length))
            .read_to_end(&mut text)
            .map_err(failed)?;
        if text.len() as u64 != u64::from(length) {
            return Err(failed(std::io::ErrorKind::UnexpectedEof.into()));
        }
        let text = String::from_utf8(text).unwrap_or_else(|latin| {
            latin
                .as_bytes()
                .iter()
                .map(|&byte| char::from(byte))
                .collect()
        });
        Self::parse(&text, bytes + u64::from(length)).map_err(|untold| match untold {
            Untold::Damaged => origin.damaged(place, "its header is no description of an array"),
            Untold::Objects => origin.unsupported(
                place,
                "an array of Python objects",
                "save numbers: `np.asarray(x, dtype=float)`, one array a signal",
            ),
            Untold::TooMany => origin.unsupported(
                place,
                format!("an array of more than {MOST_COLUMNS} columns"),
                "save fewer signals in an array",
            ),
        })
    }

    fn parse(text: &str, bytes: u64) -> Result<Self, Untold> {
        let header = Literal::parse(text).ok_or(Untold::Damaged)?;
        let get = |key| header.get(key).ok_or(Untold::Damaged);
        let dtype = Dtype::parse(get("descr")?)?;
        let axes = get("shape")?.counts().ok_or(Untold::Damaged)?;
        let Literal::Flag(is_fortran) = *get("fortran_order")? else {
            return Err(Untold::Damaged);
        };
        let elements = axes
            .iter()
            .try_fold(1_u64, |elements, &length| elements.checked_mul(length))
            .ok_or(Untold::Damaged)?;
        let data = elements.checked_mul(dtype.bytes).ok_or(Untold::Damaged)?;
        Ok(Header {
            dtype,
            axes,
            is_fortran,
            bytes,
            data,
        })
    }
}
