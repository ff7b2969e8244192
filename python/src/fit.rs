//! A model fitted to recordings.

use super::error::{identify, raised};
use super::model::Model;
use super::recording::Recording;
use super::watch::watched;
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;
use servoid_identify::FitSets;
use servoid_identify::fit::Fit as Found;
use servoid_identify::fit::scores::whole;
use servoid_identify::fit::{COSTS, Options, cost_by_name, cost_name, effects_by_name};
use servoid_io::input::{Known, MotorFile};
use servoid_io::recording::Recording as Read;
use servoid_results::report::{html, text};
use servoid_results::schema::{self, Document};
use servoid_results::{plot, report};

/// A model fitted to recordings, with its errors.
#[pyclass(frozen, module = "servoid._servoid")]
pub(crate) struct Fit {
    found: Found,
    sets: FitSets,
    json: String,
}

/// The recordings themselves.
pub(crate) fn reads(recordings: &[PyRef<'_, Recording>]) -> Vec<Read> {
    recordings.iter().map(|one| one.read.clone()).collect()
}

/// What is known of the motor: said in the call, as the `[known]` of a motor file, or else with the first recording.
pub(crate) fn known(said: Option<&str>, recordings: &[PyRef<'_, Recording>]) -> PyResult<Known> {
    match said {
        Some(text) => {
            let motor = MotorFile::parse(text, "known").map_err(|error| raised("motor", error))?;
            Ok(motor.known)
        }
        None => Ok(recordings
            .first()
            .map(|one| one.known.clone())
            .unwrap_or_default()),
    }
}

/// A page of a result, as HTML.
pub(crate) fn page(json: &str, recordings: html::Recordings<'_>) -> PyResult<String> {
    let failed = |error: &dyn std::fmt::Display| raised("failed", error);
    let value = serde_json::from_str(json).map_err(|error| failed(&error))?;
    let document = Document::from_json(value).map_err(|fault| failed(&fault))?;
    let page = report::html::page(&document, recordings).map_err(|error| failed(&error))?;
    Ok(page.render())
}

/// Fits a model. Lists of recordings are of one motor; `known` is TOML.
#[pyfunction]
#[pyo3(signature = (recordings, *, effects, validate, known, algorithm, cost, seed, budget, own, certificate, profile, force))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn fit(
    py: Python<'_>,
    recordings: Vec<PyRef<'_, Recording>>,
    effects: Vec<String>,
    validate: Vec<PyRef<'_, Recording>>,
    known: Option<&str>,
    algorithm: String,
    cost: &str,
    seed: u64,
    budget: usize,
    own: Vec<String>,
    certificate: bool,
    profile: bool,
    force: bool,
) -> PyResult<Fit> {
    let cost = cost_by_name(cost).ok_or_else(|| {
        let names: Vec<&str> = COSTS.iter().map(|cost| cost_name(*cost)).collect();
        raised(
            "usage",
            format!("cost={cost:?}: known are {}", names.join(", ")),
        )
    })?;
    let options = Options {
        effects: effects_by_name("effects", &effects).map_err(identify)?,
        cost,
        seed,
        budget,
        known: self::known(known, &recordings)?,
        algorithm,
        own,
        certificate,
        profile,
        error_ladder: true,
        force,
        ..Options::default()
    };
    let (fitted, held_out) = (reads(&recordings), reads(&validate));
    drop((recordings, validate));
    let (found, sets) = watched(py, |watch| {
        let sets = FitSets::of_several(fitted, held_out, force)?;
        let found = sets.identify(&options, watch)?;
        Ok((found, sets))
    })?
    .map_err(identify)?;
    let source = sets.held_out.as_ref().map(|data| data.source.as_str());
    let json = serde_json::to_string(&schema::Fit::new(&found, &sets.fitted, source));
    Ok(Fit {
        json: json.map_err(|error| raised("failed", error))?,
        found,
        sets,
    })
}

#[pymethods]
impl Fit {
    /// The result as the JSON of `servoid fit`.
    #[getter]
    fn json(&self) -> &str {
        &self.json
    }

    /// What a user should know of the recordings.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.sets.remarks.clone()
    }

    /// Whether the search was stopped before its end.
    #[getter]
    fn interrupted(&self) -> bool {
        self.found.interrupted
    }

    /// The result as the command line prints it.
    fn summary(&self) -> String {
        text::fit(&self.found, &self.sets.fitted)
    }

    /// Model less reading over the fitted recordings, counts, one a sample; a floored reading stands for the middle of its cell.
    fn residual<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (data, found) = (&self.sets.fitted, &self.found);
        let errors = py.detach(|| whole(data, &found.candidate, found.method));
        let errors = errors.map_err(identify)?;
        let centre = data.half_cell();
        let residual: Vec<f64> = errors.iter().map(|error| error - centre).collect();
        Ok(residual.into_pyarray(py))
    }

    /// Measured against model, as SVG.
    fn drawing(&self) -> PyResult<String> {
        let drawn = plot::overlay(&self.sets.fitted, &self.found.candidate, self.found.method);
        drawn.map_err(|error| raised("failed", error))
    }

    /// The page of the result, as HTML.
    fn page(&self) -> PyResult<String> {
        let drawn = html::Recordings {
            fitted: Some(&self.sets.fitted),
            held_out: self.sets.held_out.as_ref(),
        };
        page(&self.json, drawn)
    }

    /// The model that was found.
    #[getter]
    fn model(&self) -> PyResult<Model> {
        Model::of(&self.json)
    }
}
