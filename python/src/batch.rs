//! Many recordings, one row each.

use super::error::raised;
use super::watch::{Watched, counted};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use servoid_batch::{Batch, Error, Input, Shard, Store, Task, Verb, Watch, run, write_table};
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::thread::available_parallelism;

impl Watch for Watched {
    fn ended(&self) {
        self.count();
    }

    fn stop(&self) -> &AtomicBool {
        servoid_identify::Progress::stop(self)
    }
}

fn failed(error: Error) -> PyErr {
    match error {
        Error::Usage(_) => raised("usage", error),
        Error::Busy { .. } => raised("busy", error),
        _ => raised("failed", error),
    }
}

/// Fits or diagnoses every recording of a folder or a Parquet file, as far as the folder `out` has no result of it. Returns what
/// was done, and remarks.
#[pyfunction]
#[pyo3(signature = (input, out, *, verb, effects, algorithm, cost, evaluations, steps, seed, force, shard, retry_errors, workers, table, progress))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn batch<'py>(
    py: Python<'py>,
    input: PathBuf,
    out: PathBuf,
    verb: &str,
    effects: Vec<String>,
    algorithm: String,
    cost: String,
    evaluations: usize,
    steps: u64,
    seed: u64,
    force: bool,
    shard: &str,
    retry_errors: bool,
    workers: Option<usize>,
    table: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let verb = match verb {
        "fit" => Verb::Fit,
        "diagnose" => Verb::Diagnose,
        other => {
            return Err(raised(
                "usage",
                format!("do={other:?}: it is fit or diagnose"),
            ));
        }
    };
    let shard: Shard =
        (shard.parse()).map_err(|error| raised("usage", format!("shard={shard:?} {error}")))?;
    let task = Task {
        verb,
        effects,
        algorithm,
        cost,
        evaluations,
        steps,
        seed,
        force,
    };
    task.check().map_err(super::error::identify)?;
    let done = counted(py, progress.as_ref(), |watch| {
        let input = Input::open(&input)?;
        let mut store = Store::open(&out, shard)?;
        let batch = Batch {
            task: &task,
            shard,
            retry_errors,
            workers: workers.unwrap_or_else(|| available_parallelism().map_or(1, usize::from)),
        };
        let done = run(&input, &batch, &mut store, watch)?;
        if let Some(path) = &table {
            write_table(&out, path)?;
        }
        Ok((input.count(shard), done, std::mem::take(&mut store.remarks)))
    })?;
    let (recordings, done, remarks) = done.map_err(failed)?;
    let found = PyDict::new(py);
    found.set_item("recordings", recordings)?;
    found.set_item("there", done.there)?;
    found.set_item("made", done.made)?;
    found.set_item("errors", done.errors)?;
    found.set_item("interrupted", done.interrupted)?;
    found.set_item("remarks", remarks)?;
    Ok(found)
}

/// Writes all results of a folder as one Parquet file, ordered by recording.
#[pyfunction]
pub(crate) fn batch_table(py: Python<'_>, out: PathBuf, table: PathBuf) -> PyResult<()> {
    py.detach(|| write_table(&out, &table)).map_err(failed)
}
