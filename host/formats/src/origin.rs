//! The file that errors are about, and the format it is read as.

use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use std::io;
use std::path::Path;

/// The file that errors are about, and the format it is read as.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    source: String,
    format: Format,
}

impl Origin {
    /// The file at `path`, read as `format`.
    pub(crate) fn new(path: &Path, format: Format) -> Self {
        Origin {
            source: path.display().to_string(),
            format,
        }
    }

    /// An error at a place of the file.
    pub(crate) fn error(
        &self,
        place: impl Into<String>,
        fault: impl Into<FormatFault>,
    ) -> FormatError {
        FormatError::new(&self.source, place, fault)
    }

    /// The content contradicts the format.
    pub(crate) fn damaged(&self, place: impl Into<String>, why: impl Into<String>) -> FormatError {
        let format = self.format.name();
        let why = why.into();
        self.error(place, FormatFault::Damaged { format, why })
    }

    /// The format allows it, and it is not read here.
    pub(crate) fn unsupported(
        &self,
        place: impl Into<String>,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> FormatError {
        let (what, remedy) = (what.into(), remedy.into());
        self.error(place, FormatFault::Unsupported { what, remedy })
    }

    /// What a failed read of `what` means: a file that ends too early, bytes that contradict the
    /// format, or a fault of the system.
    pub(crate) fn failed_read(
        &self,
        place: impl Into<String>,
        what: &'static str,
        error: io::Error,
    ) -> FormatError {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => self.error(place, FormatFault::CutShort { what }),
            io::ErrorKind::InvalidData | io::ErrorKind::InvalidInput => {
                self.damaged(place, format!("{what}: {error}"))
            }
            _ => self.error(place, error),
        }
    }
}
