//! Files of cases read, and several joined.

use super::Outcome;
use super::header::{HEADER, Header};
use super::store_error::{Fault, StoreError, unreadable, wrong};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The content of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Content {
    /// What the cases are.
    pub header: Header,
    /// The cases, as they stand there, each once.
    pub outcomes: Vec<Outcome>,
}

/// Reads a file of cases.
///
/// # Errors
/// With the file, and the line where one is at fault.
pub fn read(path: &Path) -> Result<Content, StoreError> {
    let bytes = std::fs::read(path).map_err(|error| wrong(path)(unreadable(error)))?;
    parse(path, finished(&bytes))
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

/// What stands before the end of the last finished line.
pub(super) fn finished(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|&byte| byte == b'\n');
    &bytes[..end.map_or(0, |end| end + 1)]
}

/// The content of a file's finished lines.
pub(super) fn parse(path: &Path, lines: &[u8]) -> Result<Content, StoreError> {
    let mut header: Option<Header> = None;
    let mut outcomes = Vec::new();
    for (index, line) in String::from_utf8_lossy(lines).lines().enumerate() {
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
