//! What each run did: a file a run beside the results, so that every part says where it comes from.

use crate::error::{Error, content, io};
use crate::key::hex;
use crate::run::Done;
use crate::shard::Shard;
use crate::task::{Task, VERSION};
use serde::{Deserialize, Serialize};
use servoid_io::output::write_whole;
use sha2::{Digest, Sha256};
use std::fs;
use std::path::{Path, PathBuf};

/// What a run's file calls itself.
pub const SCHEMA: &str = "servoid.batch_run/1";
/// Folder of the runs within the folder of results.
const RUNS: &str = "runs";

/// One run: what it was asked for, and which parts it wrote.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Run {
    /// `servoid.batch_run/1`.
    pub schema: String,
    /// Version of servoid.
    pub version: String,
    /// When it began, UTC.
    pub started: String,
    /// When it ended; null while it works, and of one that was killed.
    pub ended: Option<String>,
    /// The recordings.
    pub input: String,
    /// How many there were.
    pub recordings: usize,
    /// What was done to each.
    pub task: Task,
    /// Its share of the recordings.
    pub shard: String,
    /// What it did; null as `ended`.
    pub done: Option<Done>,
    /// The parts that it wrote.
    pub parts: Vec<Part>,
}

/// A part of the results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Part {
    /// Its file within the folder of parts.
    pub file: String,
    /// Its rows.
    pub rows: usize,
    /// SHA-256 of the file.
    pub sha256: String,
}

impl Part {
    /// The part at `path`, as it was written.
    pub(crate) fn of(path: &Path, rows: usize) -> Result<Self, Error> {
        let bytes = fs::read(path).map_err(io(path))?;
        let name = path.file_name().unwrap_or_default();
        Ok(Part {
            file: name.to_string_lossy().into_owned(),
            rows,
            sha256: hex(&Sha256::digest(&bytes)),
        })
    }
}

/// The file of a run that is under way.
#[derive(Debug)]
pub(crate) struct Manifest {
    path: PathBuf,
    pub(crate) run: Run,
}

impl Manifest {
    /// Begins the file of a run.
    pub(crate) fn begin(
        folder: &Path,
        input: &Path,
        recordings: usize,
        task: &Task,
        shard: Shard,
    ) -> Result<Self, Error> {
        let runs = folder.join(RUNS);
        fs::create_dir_all(&runs).map_err(io(&runs))?;
        let started = now();
        let name = format!(
            "{}-{}-{}.json",
            started.replace([':', '-', '.'], ""),
            shard.to_string().replace('/', "-of-"),
            std::process::id()
        );
        let manifest = Manifest {
            path: runs.join(name),
            run: Run {
                schema: SCHEMA.to_owned(),
                version: VERSION.to_owned(),
                started,
                ended: None,
                input: input.display().to_string(),
                recordings,
                task: task.clone(),
                shard: shard.to_string(),
                done: None,
                parts: Vec::new(),
            },
        };
        manifest.write()?;
        Ok(manifest)
    }

    /// Writes it as it stands, whole.
    pub(crate) fn write(&self) -> Result<(), Error> {
        let text = serde_json::to_string_pretty(&self.run).map_err(content(&self.path))?;
        write_whole(&self.path, |out| writeln!(out, "{text}"))?;
        Ok(())
    }

    /// The run has ended.
    pub(crate) fn end(&mut self, done: Done) -> Result<(), Error> {
        self.run.ended = Some(now());
        self.run.done = Some(done);
        self.write()
    }
}

/// The runs of a folder, in the order in which they began; none where the folder has no record of them.
///
/// # Errors
/// A file that cannot be read as a run.
pub fn runs(folder: &Path) -> Result<Vec<Run>, Error> {
    let runs = folder.join(RUNS);
    let entries = match fs::read_dir(&runs) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        found => found.map_err(io(&runs))?,
    };
    let mut found: Vec<Run> = Vec::new();
    for entry in entries {
        let path = entry.map_err(io(&runs))?.path();
        if path.extension().is_some_and(|end| end == "json") {
            let text = fs::read_to_string(&path).map_err(io(&path))?;
            found.push(serde_json::from_str(&text).map_err(content(&path))?);
        }
    }
    found.sort_by(|a, b| a.started.cmp(&b.started));
    Ok(found)
}

fn now() -> String {
    jiff::Timestamp::now()
        .strftime("%Y-%m-%dT%H:%M:%S%.3fZ")
        .to_string()
}
