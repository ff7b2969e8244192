//! The runs of a comparison as a file, and several such files as one comparison: seeds that were run apart, on one machine or on many.

use crate::error::Error;
use serde::{Deserialize, Serialize};
use servoid_engine::compare::{Contest, Row};
use servoid_engine::solve::{Found, Objective};
use servoid_io::output::write_whole;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

const SCHEMA: &str = "servoid.compare-runs/1";

/// What must be alike for runs to be of one comparison.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    schema: String,
    version: String,
    budget: usize,
    /// Name and search range of each unknown.
    unknowns: Vec<(String, (f64, f64))>,
    /// Cost where the search starts: another recording or model has another one. None where it is infinite.
    start_cost: Option<f64>,
    algorithms: Vec<String>,
}

/// The file.
#[derive(Serialize, Deserialize)]
struct Kept {
    #[serde(flatten)]
    header: Header,
    seeds: Vec<u64>,
    /// A row for each of the `algorithms`.
    rows: Vec<KeptRow>,
}

#[derive(Serialize, Deserialize)]
struct KeptRow {
    wall_s: f64,
    /// A run for each of the `seeds`.
    runs: Vec<Run>,
}

#[derive(Serialize, Deserialize)]
struct Run {
    x: Vec<f64>,
    /// None where it is infinite.
    cost: Option<f64>,
    evaluations: usize,
    curve: Vec<(usize, f64)>,
}

impl Header {
    pub(super) fn of(contest: &Contest<'_>, algorithms: &[&str]) -> Self {
        let problem = contest.problem;
        let middle = || vec![0.5; problem.dim()];
        let cost = problem.cost(&problem.start().unwrap_or_else(middle));
        let unknowns = problem.structure.unknowns.iter();
        Header {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            budget: contest.budget,
            unknowns: unknowns.map(|own| (own.name.clone(), own.range)).collect(),
            start_cost: Some(cost).filter(|cost| cost.is_finite()),
            algorithms: algorithms.iter().map(|&name| name.to_owned()).collect(),
        }
    }

    /// What of a file's is not as here.
    fn difference(&self, of_file: &Header) -> Option<String> {
        let (own, other) = (self, of_file);
        if other.version != own.version {
            return Some(format!("is of version {} of servoid", other.version));
        }
        if other.budget != own.budget {
            return Some(format!("has --budget {}", other.budget));
        }
        if other.algorithms != own.algorithms {
            return Some(format!("has --algorithm {}", other.algorithms.join(",")));
        }
        let names = |header: &Header| -> Vec<String> {
            let unknowns = header.unknowns.iter();
            unknowns.map(|(name, _)| name.clone()).collect()
        };
        if names(other) != names(own) {
            return Some(format!("has the unknowns {}", names(other).join(", ")));
        }
        let what = "is of another recording, cost, search range or way to run the model";
        (other != own).then(|| what.to_owned())
    }
}

/// Writes the runs of all seeds.
pub(super) fn write(path: &Path, header: Header, seeds: &[u64], rows: &[Row]) -> Result<(), Error> {
    let run = |found: &Found| Run {
        x: found.x.clone(),
        cost: Some(found.cost).filter(|cost| cost.is_finite()),
        evaluations: found.evaluations,
        curve: found.curve.clone(),
    };
    let row = |row: &Row| KeptRow {
        wall_s: row.wall_s,
        runs: row.runs.iter().map(run).collect(),
    };
    let kept = Kept {
        header,
        seeds: seeds.to_vec(),
        rows: rows.iter().map(row).collect(),
    };
    write_whole(path, |out| {
        serde_json::to_writer(&mut *out, &kept)?;
        out.write_all(b"\n")
    })?;
    Ok(())
}

/// The seeds and rows of several files, one file's after the other's.
///
/// # Errors
/// A file that cannot be read or is of another comparison, and a seed that is there twice.
pub(super) fn merge(paths: &[PathBuf], header: &Header) -> Result<(Vec<u64>, Vec<Row>), Error> {
    let row = |name: &String| Row {
        algorithm: name.clone(),
        runs: Vec::new(),
        wall_s: 0.0,
    };
    let mut rows: Vec<Row> = header.algorithms.iter().map(row).collect();
    let (mut seeds, mut known) = (Vec::new(), BTreeSet::new());
    for path in paths {
        let kept = read(path)?;
        let wrong = |what: &str| Error::Usage(format!("--merge {}: {what}", path.display()));
        if let Some(what) = header.difference(&kept.header) {
            return Err(wrong(&format!(
                "{what}; give what its runs were made with, or leave it out"
            )));
        }
        if let Some(twice) = kept.seeds.iter().find(|&&seed| !known.insert(seed)) {
            return Err(wrong(&format!("seed {twice} is there already")));
        }
        seeds.extend(kept.seeds);
        for (row, kept) in rows.iter_mut().zip(kept.rows) {
            row.wall_s += kept.wall_s;
            row.runs.extend(kept.runs.into_iter().map(Found::from));
        }
    }
    Ok((seeds, rows))
}

fn read(path: &Path) -> Result<Kept, Error> {
    let failed = |what: &dyn std::fmt::Display| {
        Error::Failed(format!(
            "{}: {what}; --merge takes what `servoid compare --out FILE` wrote",
            path.display()
        ))
    };
    let text = std::fs::read_to_string(path).map_err(|error| failed(&error))?;
    let kept: Kept = serde_json::from_str(&text).map_err(|error| failed(&error))?;
    let unknowns = kept.header.unknowns.len();
    let mut runs = kept.rows.iter().flat_map(|row| &row.runs);
    let whole = kept.rows.len() == kept.header.algorithms.len()
        && kept
            .rows
            .iter()
            .all(|row| row.runs.len() == kept.seeds.len())
        && runs.all(|run| run.x.len() == unknowns);
    if kept.header.schema != SCHEMA || !whole {
        return Err(failed(&format!("is no {SCHEMA} with a run for each seed")));
    }
    Ok(kept)
}

impl From<Run> for Found {
    fn from(run: Run) -> Self {
        Found {
            x: run.x,
            cost: run.cost.unwrap_or(f64::INFINITY),
            evaluations: run.evaluations,
            curve: run.curve,
            interrupted: false,
        }
    }
}
