//! The file of finished cases: a line of JSON that says what they are, then one for each case.
//!
//! A line is appended whole when its case is finished, so that a killed run loses nothing but the cases
//! under way; a last line without its end is such a case, and is done again.

use super::{Outcome, SetUp};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Schema of the file.
const SCHEMA: &str = "servoid.prove-cases/1";
/// How the line that says what the cases are begins.
const HEADER: &str = "{\"schema\"";

/// What the cases of a file are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    schema: String,
    /// Version of the program that proved them.
    pub version: String,
    /// What they follow from.
    pub set_up: SetUp,
}

/// The content of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Content {
    /// What the cases are.
    pub header: Header,
    /// The cases, as they stand there, each once.
    pub outcomes: Vec<Outcome>,
}

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

impl Header {
    /// For cases of this program.
    pub fn new(set_up: &SetUp) -> Header {
        Header {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            set_up: set_up.clone(),
        }
    }

    /// How `other` differs, in the words of the flags; `None` if it does not.
    fn difference(&self, other: &Header) -> Option<String> {
        let (a, b) = (&self.set_up, &other.set_up);
        let of = |a: &[String]| {
            if a.is_empty() {
                "all".to_owned()
            } else {
                a.join(",")
            }
        };
        let pairs = [
            ("schema", self.schema.clone(), other.schema.clone()),
            ("version", self.version.clone(), other.version.clone()),
            ("--seed", a.seed.to_string(), b.seed.to_string()),
            ("--hidden", a.hidden.name(), b.hidden.name()),
            ("--excite", a.excite.name(), b.excite.name()),
            ("--effect", of(&a.effects), of(&b.effects)),
        ];
        let differences: Vec<String> = pairs
            .into_iter()
            .filter(|(_, wanted, there)| wanted != there)
            .map(|(what, wanted, there)| format!("{what} {there}, not {wanted}"))
            .collect();
        (!differences.is_empty()).then(|| differences.join("; "))
    }
}

/// A file that cases are appended to.
#[derive(Debug)]
pub struct Store {
    file: File,
    path: PathBuf,
}

impl Store {
    /// A new file.
    ///
    /// # Errors
    /// A file that is there and not empty; what the system refuses.
    pub fn create(path: &Path, header: &Header) -> Result<Store, StoreError> {
        let wrong = wrong(path);
        let there = std::fs::metadata(path);
        if there.is_ok_and(|there| there.is_file() && there.len() > 0) {
            return Err(wrong(Fault::Exists));
        }
        let mut store = Store::open(path, OpenOptions::new().append(true).create(true))?;
        store.write(header)?;
        Ok(store)
    }

    /// An existing file, its finished cases, and place for more. A line that was not finished is cut off.
    ///
    /// # Errors
    /// As [`read`]; cases of another set-up, or drawn in another way than this program does.
    pub fn resume(path: &Path, header: &Header) -> Result<(Store, Vec<Outcome>), StoreError> {
        let mut store = Store::open(path, OpenOptions::new().append(true))?;
        let wrong = wrong(path);
        let text = std::fs::read_to_string(path).map_err(|error| wrong(Fault::Io(error)))?;
        let whole = finished(&text);
        // What is to be cut must be a file of this kind first.
        let begun = text.bytes().zip(HEADER.bytes()).all(|(a, b)| a == b);
        if !begun {
            return Err(wrong(Fault::NoHeader));
        }
        let outcomes = match whole.is_empty() {
            true => Vec::new(),
            false => resumed(path, whole, header)?,
        };
        let length = whole.len() as u64;
        let cut = store.file.set_len(length);
        cut.map_err(|error| wrong(Fault::Io(error)))?;
        if whole.is_empty() {
            store.write(header)?;
        }
        Ok((store, outcomes))
    }

    /// Adds a finished case.
    ///
    /// # Errors
    /// What the system refuses.
    pub fn append(&mut self, outcome: &Outcome) -> Result<(), StoreError> {
        self.write(outcome)
    }

    fn open(path: &Path, options: &OpenOptions) -> Result<Store, StoreError> {
        let wrong = wrong(path);
        let file = options
            .open(path)
            .map_err(|error| wrong(unreadable(error)))?;
        // Where the system knows no locks, two runs at one file are the user's care.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(wrong(Fault::Busy));
        }
        Ok(Store {
            file,
            path: path.to_owned(),
        })
    }

    /// One line, in one piece.
    fn write(&mut self, value: &impl Serialize) -> Result<(), StoreError> {
        let line = serde_json::to_string(value).map_err(io::Error::from);
        line.and_then(|line| {
            self.file.write_all(format!("{line}\n").as_bytes())?;
            self.file.flush()
        })
        .map_err(|error| wrong(&self.path)(Fault::Io(error)))
    }
}

/// The cases of a file that is to be continued under `header`.
fn resumed(path: &Path, text: &str, header: &Header) -> Result<Vec<Outcome>, StoreError> {
    let content = parse(path, text)?;
    if let Some(difference) = header.difference(&content.header) {
        return Err(wrong(path)(Fault::Other(difference)));
    }
    let mut outcomes = content.outcomes.iter();
    match outcomes.find(|outcome| !outcome.is_drawn_from(&header.set_up)) {
        Some(other) => Err(wrong(path)(Fault::Differs(
            other.case,
            "this program draws it",
        ))),
        None => Ok(content.outcomes),
    }
}

/// Reads a file of cases.
///
/// # Errors
/// With the file, and the line where one is at fault.
pub fn read(path: &Path) -> Result<Content, StoreError> {
    let text = std::fs::read_to_string(path).map_err(|error| wrong(path)(unreadable(error)))?;
    parse(path, finished(&text))
}

/// Joins files of one set-up; a case that is in several counts once.
///
/// # Errors
/// As [`read`]; files of different set-ups, or a case that differs between them.
pub fn merge(paths: &[PathBuf]) -> Result<Option<Content>, StoreError> {
    let mut joint: Option<Content> = None;
    for path in paths {
        let content = read(path)?;
        let Some(joint) = &mut joint else {
            joint = Some(content);
            continue;
        };
        if let Some(difference) = joint.header.difference(&content.header) {
            return Err(wrong(path)(Fault::Other(difference)));
        }
        let all = joint.outcomes.drain(..).chain(content.outcomes);
        joint.outcomes = once(all)
            .map_err(|case| wrong(path)(Fault::Differs(case, "in the files before it")))?;
    }
    Ok(joint)
}

fn unreadable(error: io::Error) -> Fault {
    match error.kind() {
        io::ErrorKind::NotFound => Fault::Missing,
        _ => Fault::Io(error),
    }
}

fn wrong(path: &Path) -> impl Fn(Fault) -> StoreError {
    |fault| StoreError {
        path: path.to_owned(),
        line: None,
        fault,
    }
}

/// The text up to the end of its last finished line.
fn finished(text: &str) -> &str {
    &text[..text.rfind('\n').map_or(0, |end| end + 1)]
}

fn parse(path: &Path, text: &str) -> Result<Content, StoreError> {
    let mut header: Option<Header> = None;
    let mut outcomes = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let wrong = |fault| StoreError {
            line: Some(index + 1),
            ..wrong(path)(fault)
        };
        if line.starts_with(HEADER) {
            let next = serde_json::from_str(line).map_err(|e| wrong(Fault::BadHeader(e)))?;
            // Files put together by hand hold several.
            if let Some(difference) = header.as_ref().and_then(|first| first.difference(&next)) {
                return Err(wrong(Fault::Other(difference)));
            }
            header = Some(next);
        } else if header.is_none() {
            return Err(wrong(Fault::NoHeader));
        } else {
            outcomes.push(serde_json::from_str(line).map_err(|e| wrong(Fault::BadLine(e)))?);
        }
    }
    let header = header.ok_or_else(|| wrong(path)(Fault::NoHeader))?;
    let outcomes = once(outcomes)
        .map_err(|case| wrong(path)(Fault::Differs(case, "before in the same file")))?;
    Ok(Content { header, outcomes })
}

/// Each case once, in the order of their numbers; else the number of a case that was drawn in two ways.
fn once(outcomes: impl IntoIterator<Item = Outcome>) -> Result<Vec<Outcome>, u64> {
    let mut cases: BTreeMap<u64, Outcome> = BTreeMap::new();
    for outcome in outcomes {
        match cases.get(&outcome.case) {
            Some(first) if first.drawn != outcome.drawn => return Err(outcome.case),
            Some(_) => {}
            None => {
                cases.insert(outcome.case, outcome);
            }
        }
    }
    Ok(cases.into_values().collect())
}
