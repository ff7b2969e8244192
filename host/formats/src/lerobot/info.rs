//! What `meta/info.json` says of a dataset.

use crate::error::{FormatError, FormatFault};
use crate::log::{Column, Kind};
use crate::parquet::Step;
use crate::shape::{MOST_COLUMNS, MOST_ELEMENTS};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// Bytes of the file.
const MOST_BYTES: u64 = 16 << 20;
/// Episodes in a folder of version 2, where the file does not say it.
const CHUNK: u64 = 1000;

/// The file's content, as far as it is used.
#[derive(Debug, Deserialize)]
pub(crate) struct Info {
    codebase_version: String,
    data_path: Option<String>,
    chunks_size: Option<u64>,
    /// How many episodes there are.
    pub(crate) total_episodes: Option<u64>,
    #[serde(deserialize_with = "in_order")]
    features: Vec<(String, Feature)>,
}

#[derive(Debug, Deserialize)]
struct Feature {
    dtype: String,
    #[serde(default)]
    shape: Vec<usize>,
    #[serde(default)]
    names: serde_json::Value,
}

/// Where the values of a column are within those of its feature.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// The feature.
    pub(crate) feature: String,
    /// The indices of its element.
    pub(crate) steps: Vec<Step>,
}

impl Info {
    pub(crate) fn read(path: &Path) -> Result<Self, FormatError> {
        let source = path.display().to_string();
        let fail = |fault: FormatFault| FormatError::new(&source, "", fault);
        let file = File::open(path).map_err(|error| fail(error.into()))?;
        let mut text = Vec::new();
        let read = file.take(MOST_BYTES).read_to_end(&mut text);
        read.map_err(|error| fail(error.into()))?;
        let info: Info =
            serde_json::from_slice(&text).map_err(|error| fail(damaged(error.to_string())))?;
        if info.version().is_none() {
            return Err(fail(FormatFault::Unsupported {
                what: format!("a dataset of version {}", info.codebase_version),
                remedy: "convert it to version 3 with LeRobot".to_owned(),
            }));
        }
        Ok(info)
    }

    /// 2 or 3: in 2 each episode is a file, in 3 a file holds many.
    pub(crate) fn version(&self) -> Option<u8> {
        let version = self.codebase_version.trim_start_matches('v');
        match version.split('.').next()? {
            "2" => Some(2),
            "3" => Some(3),
            _ => None,
        }
    }

    /// The file of version 3 with those numbers; `None` where the dataset names its files in another way.
    pub(crate) fn file(&self, chunk: u64, file: u64) -> Option<PathBuf> {
        let pattern = (self.data_path.as_deref())
            .unwrap_or("data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet");
        filled(pattern, &[("chunk_index", chunk), ("file_index", file)])
    }

    /// The file of version 2 with that episode.
    pub(crate) fn file_of(&self, episode: u64) -> Option<PathBuf> {
        let pattern = (self.data_path.as_deref())
            .unwrap_or("data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet");
        let chunk = episode.checked_div(self.chunks_size.unwrap_or(CHUNK))?;
        filled(
            pattern,
            &[("episode_chunk", chunk), ("episode_index", episode)],
        )
    }

    /// The columns of each episode. Images and films are no columns.
    pub(crate) fn columns(&self) -> Vec<(Column, Place)> {
        let mut out = Vec::new();
        for (name, feature) in &self.features {
            if let Some(kind) = kind_of(name, &feature.dtype) {
                feature.columns(name, kind, &mut out);
            }
        }
        out.truncate(MOST_COLUMNS);
        out
    }
}

impl Feature {
    fn columns(&self, feature: &str, kind: Kind, out: &mut Vec<(Column, Place)>) {
        let mut add = |name: String, steps: Vec<Step>| {
            let column = Column {
                name,
                kind,
                unit: None,
            };
            let feature = feature.to_owned();
            out.push((column, Place { feature, steps }));
        };
        let elements = self
            .shape
            .iter()
            .try_fold(1, |all: usize, length| all.checked_mul(*length));
        let Some(elements) = elements.filter(|elements| *elements <= MOST_ELEMENTS) else {
            return;
        };
        if self.shape.is_empty() || self.shape == [1] {
            return add(feature.to_owned(), Vec::new());
        }
        let names = names(&self.names, elements);
        for at in 0..elements {
            let (mut steps, mut indices, mut rest) = (Vec::new(), String::new(), at);
            for length in self.shape.iter().rev() {
                let index = rest.checked_rem(*length).unwrap_or(0);
                rest = rest.checked_div(*length).unwrap_or(0);
                steps.insert(0, Step::Element(index));
                indices.insert_str(0, &format!("[{index}]"));
            }
            match names.get(at) {
                Some(name) => add(format!("{feature}.{name}"), steps),
                None => add(format!("{feature}{indices}"), steps),
            }
        }
    }
}

/// The names of the elements: a list, or a list under a name of its own; none unless they tell all elements apart.
fn names(said: &serde_json::Value, elements: usize) -> Vec<String> {
    let list = match said {
        serde_json::Value::Object(lists) if lists.len() == 1 => lists.values().next(),
        said => Some(said),
    };
    let list = list.and_then(|list| list.as_array()).into_iter().flatten();
    let names: Vec<String> = list
        .filter_map(|name| name.as_str().map(str::to_owned))
        .collect();
    let mut distinct = names.clone();
    distinct.sort_unstable();
    distinct.dedup();
    if names.len() == elements && distinct.len() == elements {
        names
    } else {
        Vec::new()
    }
}

fn kind_of(name: &str, dtype: &str) -> Option<Kind> {
    match dtype {
        "video" | "image" => None,
        "bool" => Some(Kind::Flag),
        _ if name == "timestamp" => Some(Kind::Time),
        "string" => Some(Kind::Text),
        _ if dtype.starts_with("float") || dtype.contains("int") => Some(Kind::Number),
        _ => Some(Kind::Text),
    }
}

/// A path of Python's pattern, with numbers for its names; `None` if a name is left, or if it leads out of the folder.
fn filled(pattern: &str, numbers: &[(&str, u64)]) -> Option<PathBuf> {
    let (mut out, mut rest) = (String::new(), pattern);
    while let Some((before, from)) = rest.split_once('{') {
        let (field, after) = from.split_once('}')?;
        let (name, how) = field.split_once(':').unwrap_or((field, ""));
        let (_, number) = numbers.iter().find(|(known, _)| *known == name)?;
        let width = how.trim_end_matches('d').parse::<u8>().unwrap_or(0);
        out.push_str(before);
        out.push_str(&format!("{number:0width$}", width = usize::from(width)));
        rest = after;
    }
    out.push_str(rest);
    let path = PathBuf::from(out);
    let within = |part: Component<'_>| matches!(part, Component::Normal(_));
    path.components().all(within).then_some(path)
}

/// What is wrong with the content of a dataset.
pub(crate) fn damaged(why: String) -> FormatFault {
    FormatFault::Damaged {
        format: "LeRobot dataset",
        why,
    }
}

/// The features in the order of the file, which is that of the robot's joints.
fn in_order<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(String, Feature)>, D::Error> {
    struct InOrder;
    impl<'de> Visitor<'de> for InOrder {
        type Value = Vec<(String, Feature)>;

        fn expecting(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            text.write_str("features with their names")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
            let mut features = Vec::new();
            while let Some(feature) = map.next_entry()? {
                features.push(feature);
            }
            Ok(features)
        }
    }
    from.deserialize_map(InOrder)
}

#[cfg(test)]
mod tests {
    use super::filled;
    use std::path::PathBuf;

    #[test]
    fn patterns_of_python_are_filled_and_stay_in_the_folder() {
        let numbers = [("chunk_index", 0), ("file_index", 12)];
        let pattern = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet";
        let path = PathBuf::from("data/chunk-000/file-012.parquet");
        assert_eq!(filled(pattern, &numbers), Some(path));
        assert_eq!(filled("data/{other}.parquet", &numbers), None);
        assert_eq!(filled("../{file_index}.parquet", &numbers), None);
        assert_eq!(filled("/etc/{file_index}", &numbers), None);
    }
}
