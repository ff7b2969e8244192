//! What a user should know of the recordings beside the diagnosis.

use std::fmt;

/// A remark on the recordings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    text: String,
    /// Whether this alone can keep any model from explaining the recordings.
    spoils: bool,
}

impl Remark {
    /// A remark that explains no error.
    pub fn aside(text: String) -> Self {
        Remark {
            text,
            spoils: false,
        }
    }

    /// A fault of the recordings by which any model must fail.
    pub fn cause(text: String) -> Self {
        Remark { text, spoils: true }
    }

    /// Whether this alone can keep any model from explaining the recordings.
    pub fn spoils(&self) -> bool {
        self.spoils
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
