//! Which kind of JSON a file is, told by its first bytes.

use super::lenient::Lenient;
use crate::detect::Format;
use serde::de::IgnoredAny;
use serde_json::Deserializer;
use std::io::Read;

/// The kind of JSON that begins with `head`, which need not be all of the file; `None` for a text
/// that is none.
pub(crate) fn format_of(head: &[u8]) -> Option<Format> {
    let mut text = Vec::new();
    Lenient::new(head).read_to_end(&mut text).ok()?;
    // A word at the end may have been cut.
    let is_word = |byte: &u8| byte.is_ascii_alphabetic() || *byte == b'-';
    let end = text.iter().rposition(|byte| !is_word(byte))?;
    let text = text.get(..=end)?.trim_ascii_start();
    let is_object = text.first() == Some(&b'{');
    if !is_object && text.first() != Some(&b'[') {
        return None;
    }
    let mut values = Deserializer::from_slice(text).into_iter::<IgnoredAny>();
    match values.next()? {
        Ok(_) => {
            let rest = text.get(values.byte_offset()..)?.trim_ascii_start();
            match rest.first() {
                None => Some(Format::Json),
                next if next == text.first() => Some(Format::JsonLines),
                // What begins as an object does is nothing else, and whoever reads it is told
                // the place.
                Some(_) => is_object.then_some(Format::Json),
            }
        }
        Err(error) if error.is_eof() => Some(Format::Json),
        Err(_) => is_begun_object(text).then_some(Format::Json),
    }
}

fn is_begun_object(text: &[u8]) -> bool {
    let inside = text.strip_prefix(b"{").map(<[u8]>::trim_ascii_start);
    inside.is_some_and(|inside| inside.first() == Some(&b'"'))
}
