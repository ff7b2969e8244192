//! `FILE#PART`: one recording of a file that holds several.

use super::read_error::ReadFault;
use super::reading::Reading;
use super::shown::quoted_list;
use std::path::{Path, PathBuf};

/// A file, and which of its recordings is meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The file.
    pub path: PathBuf,
    /// The name or the number of the recording; `None` for all of them.
    pub name: Option<String>,
}

impl Part {
    /// What a user means by a path. A file whose own name has a `#` is meant as a whole.
    pub fn of(path: &Path) -> Self {
        let whole = Part {
            path: path.to_owned(),
            name: None,
        };
        let Some((file, name)) = path.to_str().and_then(|text| text.rsplit_once('#')) else {
            return whole;
        };
        if name.is_empty() || path.exists() || !Path::new(file).exists() {
            return whole;
        }
        Part {
            path: file.into(),
            name: Some(name.to_owned()),
        }
    }
}

impl Reading {
    /// The recording that a part's name means, or all.
    pub(super) fn part(mut self, source: &str, name: Option<&str>) -> Result<Self, ReadFault> {
        let Some(name) = name else {
            return Ok(self);
        };
        let names: Vec<String> = (self.recordings.iter())
            .map(|recording| short_name(source, &recording.source).to_owned())
            .collect();
        let by_number = || {
            let number: usize = name.parse().ok()?;
            (1..=names.len()).contains(&number).then(|| number - 1)
        };
        let Some(index) = (names.iter().position(|own| own == name)).or_else(by_number) else {
            let known = if names.len() == 1 {
                "one recording; give the file's name alone".to_owned()
            } else {
                quoted_list(&names)
            };
            return Err(ReadFault::NoSuchPart {
                part: name.to_owned(),
                known,
            });
        };
        self.recordings = vec![self.recordings.swap_remove(index)];
        Ok(self)
    }

    /// The only recording.
    pub(super) fn only(mut self, source: &str) -> Result<Self, ReadFault> {
        if self.recordings.len() > 1 {
            return Err(ReadFault::Several {
                count: self.recordings.len(),
                source_name: source.to_owned(),
                first: short_name(source, &self.recordings[0].source).to_owned(),
            });
        }
        self.recordings.truncate(1);
        Ok(self)
    }
}

/// What follows the `#` in the source of a recording.
fn short_name<'s>(file: &str, source: &'s str) -> &'s str {
    let rest = source.strip_prefix(file).unwrap_or(source);
    rest.strip_prefix('#').unwrap_or(rest)
}
