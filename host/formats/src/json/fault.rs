//! What an error of serde means.

use crate::error::{FormatError, FormatFault};
use crate::origin::Origin;
use serde_json::error::Category;

/// The error at its line and column; `refused` is why a value was not taken.
pub(crate) fn fault(
    origin: &Origin,
    refused: Option<FormatFault>,
    error: serde_json::Error,
) -> FormatError {
    let place = format!("line {}, column {}", error.line(), error.column());
    if let Some(fault) = refused {
        return origin.error(place, fault);
    }
    let what = "a value";
    match error.classify() {
        Category::Io => origin.failed_read(place, what, error.into()),
        Category::Eof => origin.error(place, FormatFault::CutShort { what }),
        Category::Syntax | Category::Data => {
            let text = error.to_string();
            let why = text.rsplit_once(" at line ").map_or(&*text, |(why, _)| why);
            origin.damaged(place, why)
        }
    }
}
