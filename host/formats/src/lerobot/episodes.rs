//! Which episodes a dataset has, and which file each of them is in.

use super::info::{Info, damaged};
use crate::batch::Start;
use crate::error::{FormatError, FormatFault};
use crate::parquet::{ParquetFile, Part, Source, in_batch};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, Read};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Episodes of a dataset.
const MOST_EPISODES: usize = 1 << 20;
/// Bytes of a line of `meta/episodes.jsonl`.
const MOST_LINE: u64 = 1 << 20;

/// One episode.
#[derive(Clone, Debug)]
pub(crate) struct Episode {
    /// Its number.
    pub(crate) index: u64,
    /// Its rows, where the dataset says it.
    pub(crate) rows: Option<u64>,
    /// The file it is in.
    pub(crate) path: PathBuf,
}

/// The episodes of a dataset, in their order.
pub(crate) fn episodes(root: &Path, info: &Info) -> Result<Vec<Episode>, FormatError> {
    let mut found = if info.version() == Some(2) {
        one_a_file(root, info)?
    } else {
        let listed = listed(root, info)?;
        if listed.is_empty() {
            in_data(root)?
        } else {
            listed
        }
    };
    found.sort_by_key(|episode| episode.index);
    Ok(found)
}

/// Version 2: `meta/episodes.jsonl` has a line for each.
fn one_a_file(root: &Path, info: &Info) -> Result<Vec<Episode>, FormatError> {
    #[derive(Deserialize)]
    struct Line {
        episode_index: u64,
        length: Option<u64>,
    }
    let path = root.join("meta").join("episodes.jsonl");
    let source = path.display().to_string();
    let fail = |fault: FormatFault| FormatError::new(&source, "", fault);
    let episode = |index: u64, rows: Option<u64>| {
        let file = info.file_of(index).ok_or_else(|| pattern(root))?;
        let path = root.join(file);
        Ok::<_, FormatError>(Episode { index, rows, path })
    };
    let mut lines = match File::open(&path) {
        Ok(file) => BufReader::new(file),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            let known = info.total_episodes.unwrap_or(0).min(MOST_EPISODES as u64);
            return (0..known).map(|index| episode(index, None)).collect();
        }
        Err(error) => return Err(fail(error.into())),
    };
    let mut found = Vec::new();
    loop {
        let mut line = Vec::new();
        let read = (&mut lines).take(MOST_LINE).read_until(b'\n', &mut line);
        if read.map_err(|error| fail(error.into()))? == 0 || found.len() >= MOST_EPISODES {
            return Ok(found);
        }
        if line.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        let line: Line =
            serde_json::from_slice(&line).map_err(|error| fail(damaged(error.to_string())))?;
        found.push(episode(line.episode_index, line.length)?);
    }
}

/// Version 3: the tables in `meta/episodes` have a row for each.
fn listed(root: &Path, info: &Info) -> Result<Vec<Episode>, FormatError> {
    let mut found = Vec::new();
    for path in parquet_files(&root.join("meta").join("episodes"))? {
        let file = ParquetFile::open(&path)?;
        let columns = ["episode_index", "data/chunk_index", "data/file_index"];
        let columns = columns.map(|name| column(&file, name));
        let [Some(index), Some(chunk), Some(number)] = columns else {
            let why = "it lacks episode_index, data/chunk_index or data/file_index".to_owned();
            return Err(FormatError::new(file.source(), "", damaged(why)));
        };
        let length = column(&file, "length");
        let mut foreign = false;
        let mut columns = vec![index, chunk, number];
        columns.extend(length);
        each_row(&file, &columns, &mut |row| {
            let &[Some(index), Some(chunk), Some(number), ref rows @ ..] = row else {
                return;
            };
            let rows = rows.first().copied().flatten();
            match info.file(chunk, number) {
                Some(path) if found.len() < MOST_EPISODES => found.push(Episode {
                    index,
                    rows,
                    path: root.join(path),
                }),
                Some(_) => {}
                None => foreign = true,
            }
        })?;
        if foreign {
            return Err(pattern(root));
        }
    }
    Ok(found)
}

/// Without such tables, the data say themselves what they hold.
fn in_data(root: &Path) -> Result<Vec<Episode>, FormatError> {
    let mut found: BTreeMap<u64, Episode> = BTreeMap::new();
    for path in parquet_files(&root.join("data"))? {
        let file = ParquetFile::open(&path)?;
        let Some(index) = column(&file, "episode_index") else {
            continue;
        };
        each_row(&file, &[index], &mut |row| {
            if let &[Some(index)] = row
                && (found.len() < MOST_EPISODES || found.contains_key(&index))
            {
                let episode = found.entry(index).or_insert_with(|| Episode {
                    index,
                    rows: Some(0),
                    path: path.clone(),
                });
                episode.rows = episode.rows.map(|rows| rows.saturating_add(1));
            }
        })?;
    }
    Ok(found.into_values().collect())
}

/// The column of whole numbers with that name.
pub(crate) fn column(file: &ParquetFile, name: &str) -> Option<usize> {
    let (root, field) = file.schema().column_with_name(name)?;
    field.data_type().is_integer().then_some(root)
}

fn each_row(
    file: &ParquetFile,
    columns: &[usize],
    each: &mut dyn FnMut(&[Option<u64>]),
) -> Result<(), FormatError> {
    let mut roots = columns.to_vec();
    roots.sort_unstable();
    file.read(&roots, Part::default(), &mut |batch| {
        let column = |root: &usize| {
            let source = Source {
                root: *root,
                steps: Vec::new(),
            };
            in_batch(batch, &roots, &source, &mut Start::default())
        };
        let values = columns.iter().map(column).collect::<Result<Vec<_>, _>>()?;
        for row in 0..batch.num_rows() {
            // Numbers of files and rows are far below where doubles have gaps.
            let whole = |column: &Vec<f64>| {
                let number = column.get(row).copied().filter(|number| *number >= 0.0)?;
                Some(number as u64)
            };
            let row: Vec<Option<u64>> = values.iter().map(whole).collect();
            each(&row);
        }
        Ok(ControlFlow::Continue(()))
    })
}

/// The Parquet files in the folders of a folder, in order; none where it does not exist.
fn parquet_files(folder: &Path) -> Result<Vec<PathBuf>, FormatError> {
    let mut files = Vec::new();
    for chunk in entries(folder)? {
        if chunk.is_dir() {
            files.extend(entries(&chunk)?);
        } else {
            files.push(chunk);
        }
    }
    files.retain(|path| path.extension().is_some_and(|end| end == "parquet"));
    files.sort_unstable();
    Ok(files)
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, FormatError> {
    let fail = |error: io::Error| FormatError::new(&folder.display().to_string(), "", error);
    match fs::read_dir(folder) {
        Ok(entries) => entries
            .map(|entry| Ok(entry.map_err(fail)?.path()))
            .collect(),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(fail(error)),
    }
}

fn pattern(root: &Path) -> FormatError {
    let source = root.join("meta").join("info.json").display().to_string();
    let why = "its data_path names files that are not in this folder".to_owned();
    FormatError::new(&source, "data_path", damaged(why))
}
