//! Short parts of a variable: names, axes and texts.

use super::stream::{Stream, damaged};
use super::value::Value;
use crate::number::{Class, Number};
use std::io;

/// Bytes of a name, of a text or of a list of axes.
const LONGEST: u64 = 1 << 20;

/// Reads the next element, a short one.
pub(crate) fn part(stream: &mut Stream, end: u64) -> io::Result<Vec<u8>> {
    let tag = stream.tag(end)?;
    stream.data(tag, LONGEST)
}

/// The first word of a part.
pub(crate) fn word(bytes: &[u8], big: bool) -> Option<u32> {
    let first = bytes.first_chunk::<4>()?;
    Some(if big {
        u32::from_be_bytes(*first)
    } else {
        u32::from_le_bytes(*first)
    })
}

/// The length along each axis.
pub(crate) fn axes(bytes: &[u8], big: bool) -> io::Result<Vec<u64>> {
    let length = |bytes: &[u8]| word(bytes, big).filter(|length| *length <= i32::MAX as u32);
    let axes: Option<Vec<u64>> = bytes
        .chunks(4)
        .map(|bytes| length(bytes).map(u64::from))
        .collect();
    axes.ok_or_else(|| damaged("an array has an axis of negative length"))
}

/// A name: letters up to the first zero.
pub(crate) fn text(bytes: &[u8]) -> String {
    let name = bytes.split(|&byte| byte == 0).next().unwrap_or(&[]);
    String::from_utf8_lossy(name).into_owned()
}

/// A text of one line.
pub(crate) fn letters(stream: &mut Stream, end: u64, axes: &[u64]) -> io::Result<Value> {
    if axes.first() != Some(&1) {
        return Ok(Value::Nothing);
    }
    let tag = stream.tag(end)?;
    if tag.bytes > LONGEST {
        return Ok(Value::Nothing);
    }
    let big = stream.big;
    let data = stream.data(tag, LONGEST)?;
    let number = Number {
        class: Class::U16,
        big,
    };
    Ok(match tag.kind {
        4 | 17 => {
            let codes = data.chunks_exact(2).map(|bytes| number.value(bytes) as u16);
            let letters = char::decode_utf16(codes);
            let letter = |letter: Result<char, _>| letter.unwrap_or(char::REPLACEMENT_CHARACTER);
            Value::Text(letters.map(letter).collect())
        }
        2 => Value::Text(data.iter().map(|&byte| char::from(byte)).collect()),
        1 | 16 => Value::Text(String::from_utf8_lossy(&data).into_owned()),
        _ => Value::Nothing,
    })
}
