//! Which effects recordings show that the linear motor lacks.

use super::error::{identify, raised};
use super::fit::{known, page, reads};
use super::model::Model;
use super::recording::Recording;
use super::watch::watched;
use pyo3::prelude::*;
use servoid_identify::diagnose::Budget;
use servoid_identify::fit::{Options, effects_by_name};
use servoid_identify::{Datasets, Progress, diagnose_datasets};
use servoid_results::report::diagnosis::DiagnosisReport;
use servoid_results::report::html;
use servoid_results::schema;

/// A diagnosis: a verdict, the effects that were named, and what they were chosen from.
#[pyclass(frozen, module = "servoid._servoid")]
pub(crate) struct Diagnosis {
    sets: Datasets,
    json: String,
    summary: String,
    interrupted: bool,
}

/// Names the missing effects. Lists of recordings are of one motor; `known` is TOML; `laws` are tried beside the catalogue; `steps` bounds the steps of a model.
#[pyfunction]
#[pyo3(signature = (recordings, *, validate, known, laws, discover, seed, steps, force))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn diagnose(
    py: Python<'_>,
    recordings: Vec<PyRef<'_, Recording>>,
    validate: Vec<PyRef<'_, Recording>>,
    known: Option<&str>,
    laws: Vec<String>,
    discover: bool,
    seed: u64,
    steps: Option<u64>,
    force: bool,
) -> PyResult<Diagnosis> {
    let options = Options {
        known: self::known(known, &recordings)?,
        candidates: effects_by_name("laws", &laws).map_err(identify)?,
        discover,
        seed,
        force,
        ..Options::default()
    };
    let (fitted, held_out) = (reads(&recordings), reads(&validate));
    drop((recordings, validate));
    watched(py, |watch| {
        let sets = Datasets::of_several(fitted, held_out, &options).map_err(identify)?;
        let budget = steps.map_or_else(
            || Budget::usual(watch.stop()),
            |most| Budget::of(most, watch.stop()),
        );
        let found = diagnose_datasets(&sets, &options, &budget, watch).map_err(identify)?;
        let report = DiagnosisReport::new(&found, &sets.fitted, &sets.kind, seed, None);
        let json = serde_json::to_string(&schema::Diagnosis::from(&report));
        let (json, summary) = (
            json.map_err(|error| raised("failed", error))?,
            report.text(),
        );
        Ok(Diagnosis {
            interrupted: found.interrupted,
            json,
            summary,
            sets,
        })
    })?
}

#[pymethods]
impl Diagnosis {
    /// The result as the JSON of `servoid diagnose`.
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// Whether the search was stopped before its end.
    #[getter]
    fn interrupted(&self) -> bool {
        self.interrupted
    }

    /// The result as the command line prints it.
    fn summary(&self) -> &str {
        &self.summary
    }

    /// The page of the result, as HTML.
    fn page(&self) -> PyResult<String> {
        let whole = self.sets.whole.as_deref().unwrap_or(&self.sets.fitted);
        let drawn = html::Recordings {
            fitted: Some(whole),
            held_out: self.sets.kind.source().map(|_| &self.sets.held_out),
        };
        page(&self.json, drawn)
    }

    /// The last model.
    #[getter]
    fn model(&self) -> PyResult<Model> {
        Model::of(&self.json)
    }
}
