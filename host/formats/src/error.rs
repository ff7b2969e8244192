//! What may be wrong with a file.

use std::io;

/// A file that cannot be read, with the place.
#[derive(Debug, thiserror::Error)]
#[error("{source_name}{}{place}: {fault}", if place.is_empty() { "" } else { ": " })]
pub struct FormatError {
    /// The file.
    pub source_name: String,
    /// Where in it: a byte, a variable, a channel, a row group; empty for the file as a whole.
    pub place: String,
    /// What is wrong.
    #[source]
    pub fault: FormatFault,
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
pub enum FormatFault {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
    /// The file ends too early.
    #[error("the file ends here, in the middle of {what}; it was cut short: copy it again")]
    CutShort {
        /// What was being read.
        what: &'static str,
    },
    /// The content contradicts the format.
    #[error("this is no valid {format}: {why}")]
    Damaged {
        /// The format.
        format: &'static str,
        /// What is wrong there.
        why: String,
    },
    /// The format allows it, and this reader does not know it.
    #[error("{what} cannot be read here; {remedy}")]
    Unsupported {
        /// What it is.
        what: String,
        /// What the user can do.
        remedy: String,
    },
    /// It would need more memory than is allowed.
    #[error("{what} is larger than this reader allows ({limit} bytes)")]
    TooLarge {
        /// What it is.
        what: String,
        /// The limit.
        limit: u64,
    },
    /// Texts cannot be handed on as numbers.
    #[error("the column holds texts and no numbers")]
    Text,
    /// There is nothing of the kind in the file.
    #[error("there is no such table or column")]
    Absent,
}

impl FormatError {
    /// An error at a place in a file.
    pub fn new(source: &str, place: impl Into<String>, fault: impl Into<FormatFault>) -> Self {
        FormatError {
            source_name: source.to_owned(),
            place: place.into(),
            fault: fault.into(),
        }
    }
}
