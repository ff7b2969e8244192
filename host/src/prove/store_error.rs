//! What can be wrong with a file of cases, and what to do about it.

use std::io;
use std::path::{Path, PathBuf};

/// A file of cases that cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}{fault}", place(.path, .line))]
pub struct StoreError {
    /// The file.
    pub path: PathBuf,
    /// Line in it, from 1, where one is at fault.
    pub line: Option<usize>,
    /// What is wrong and what to do.
    pub fault: Fault,
}

/// What is wrong with it.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The system refuses.
    #[error("{0}")]
    Io(io::Error),
    /// There is something already.
    #[error("exists already; continue it with --resume, or name another file")]
    Exists,
    /// There is nothing.
    #[error("is not there; such a file is begun with --out")]
    Missing,
    /// Nothing is in it that says what the cases are.
    #[error(
        "does not begin with the line that says what the cases are; it is no file of servoid prove --out"
    )]
    NoHeader,
    /// A line that is no case.
    #[error("is no finished case ({0}); delete the line, and the case is done again")]
    BadLine(serde_json::Error),
    /// A header that cannot be read.
    #[error("cannot be read ({0}); it was made by another version, or is no file of servoid prove")]
    BadHeader(serde_json::Error),
    /// The cases are of another set-up.
    #[error("holds cases of another set-up: {0}; give the same, or name another file")]
    Other(String),
    /// A case that was drawn in another way.
    #[error("case {0} was drawn in another way than {1}; do not mix them")]
    Differs(u64, &'static str),
    /// Two runs at the same file.
    #[error("is being written by another run; wait for it, or name another file")]
    Busy,
}

fn place(path: &Path, line: &Option<usize>) -> String {
    match line {
        Some(line) => format!("{}:{line}: ", path.display()),
        None => format!("{}: ", path.display()),
    }
}

/// What the system said of a file that is to be read.
pub(super) fn unreadable(error: io::Error) -> Fault {
    match error.kind() {
        io::ErrorKind::NotFound => Fault::Missing,
        _ => Fault::Io(error),
    }
}

/// A fault of the file as a whole.
pub(super) fn wrong(path: &Path) -> impl Fn(Fault) -> StoreError {
    |fault| StoreError {
        path: path.to_owned(),
        line: None,
        fault,
    }
}
