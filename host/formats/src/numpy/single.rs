//! Arrays without axes: a single value.

use super::dtype::Scalar;
use super::header::Header;
use std::io::{self, Read};

/// Bytes of a single value that is kept.
const LONGEST: u64 = 1 << 14;

/// The single value that `data` begins with, as a text; `None` where it is neither a number nor a
/// text, or is too long.
pub(crate) fn value(header: &Header, data: &mut dyn Read) -> io::Result<Option<String>> {
    let [field] = header.dtype.fields.as_slice() else {
        return Ok(None);
    };
    if header.data > LONGEST {
        return Ok(None);
    }
    let mut bytes = Vec::new();
    data.take(header.data).read_to_end(&mut bytes)?;
    if (bytes.len() as u64) < header.data {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    Ok(match field.scalar {
        Scalar::Number(number) => Some(number.value(&bytes).to_string()),
        Scalar::Flag => Some(bytes.iter().any(|&byte| byte != 0).to_string()),
        Scalar::Text if header.dtype.is_unicode => Some(text(&bytes)),
        Scalar::Text | Scalar::Ticks { .. } => None,
    })
}

/// A text of NumPy: letters of four bytes, filled up with zeros.
fn text(bytes: &[u8]) -> String {
    let letter = |letter: &[u8]| {
        let code = u32::from_le_bytes(letter.try_into().ok()?);
        char::from_u32(code).filter(|letter| *letter != '\0')
    };
    bytes.chunks_exact(4).map_while(letter).collect()
}
