//! What a batch says of all motors together, and motors drawn from their population.

use super::error::raised;
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use servoid_fleet::{Error, Fleet, LabelFile, Population, draw, page};
use std::path::PathBuf;

fn failed(error: Error) -> PyErr {
    match error {
        Error::Usage(_) => raised("usage", error),
        _ => raised("failed", error),
    }
}

fn json(found: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(found).map_err(|error| raised("failed", error))
}

fn read(results: &std::path::Path, labels: Option<&std::path::Path>) -> Result<Fleet, Error> {
    let labels = labels.map(LabelFile::read).transpose()?;
    Fleet::read(results, labels.as_ref())
}

/// `servoid.fleet/1` of a folder of results, and its page as HTML.
#[pyfunction]
pub(crate) fn fleet(
    py: Python<'_>,
    results: PathBuf,
    labels: Option<PathBuf>,
) -> PyResult<(String, String)> {
    let (summary, page) = py
        .detach(|| {
            let fleet = read(&results, labels.as_deref())?;
            let summary = fleet.summary();
            let page = page(&fleet, &summary, fleet.population().ok().as_ref())?;
            Ok((summary, page.render()))
        })
        .map_err(failed)?;
    Ok((json(&summary)?, page))
}

/// `servoid.population/1` of a folder of results.
#[pyfunction]
pub(crate) fn population(
    py: Python<'_>,
    results: PathBuf,
    labels: Option<PathBuf>,
) -> PyResult<String> {
    let found = py.detach(|| read(&results, labels.as_deref())?.population());
    json(&found.map_err(failed)?)
}

/// Motors drawn from a population: an array a parameter.
#[pyfunction]
pub(crate) fn draw_motors<'py>(
    py: Python<'py>,
    population: &str,
    count: usize,
    seed: u64,
) -> PyResult<Bound<'py, PyDict>> {
    let population: Population =
        serde_json::from_str(population).map_err(|error| raised("usage", error))?;
    let draws = py
        .detach(|| draw(&population, count, seed))
        .map_err(failed)?;
    let arrays = PyDict::new(py);
    for (k, name) in draws.names.iter().enumerate() {
        let column: Vec<f64> = draws.rows.iter().map(|row| row[k]).collect();
        arrays.set_item(name, column.into_pyarray(py))?;
    }
    Ok(arrays)
}
