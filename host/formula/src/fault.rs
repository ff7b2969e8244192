//! What is wrong with a formula, and where.

use std::fmt;

/// What is wrong with a formula.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Fault {
    /// The formula.
    pub text: String,
    /// Place of the first character that is wrong, in bytes.
    pub at: usize,
    /// What is wrong, with what was expected.
    pub what: String,
}

impl Fault {
    pub(crate) fn new(text: &str, at: usize, what: impl Into<String>) -> Self {
        Fault {
            text: text.to_owned(),
            at: at.min(text.len()),
            what: what.into(),
        }
    }
}

/// Characters of a formula that are shown on either side of the place.
const AROUND: usize = 36;

impl fmt::Display for Fault {
    /// The reason, and below it the place with a mark.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let before = self.text.get(..self.at).unwrap_or(&self.text);
        let column = before.chars().count();
        let from = column.saturating_sub(AROUND);
        let shown: String = (self.text.chars().skip(from).take(2 * AROUND))
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        writeln!(f, "{} (character {})", self.what, column + 1)?;
        writeln!(f, "  {shown}")?;
        write!(f, "  {:>width$}", "^", width = column - from + 1)
    }
}
