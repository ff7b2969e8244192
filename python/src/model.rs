//! A model that runs again.

use super::error::raised;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::{Commands, response};
use servoid_results::export::{Format, Options, Side, Subject};
use servoid_results::schema::Identified;

/// A model with all its numbers.
#[pyclass(frozen, module = "servoid._servoid")]
pub(crate) struct Model {
    found: Identified,
    candidate: Candidate,
}

impl Model {
    /// The model of a result.
    pub(crate) fn of(json: &str) -> PyResult<Self> {
        let failed = |error: &dyn std::fmt::Display| raised("result", error);
        let found = Identified::parse(json).map_err(|fault| failed(&fault))?;
        let candidate = (found.model.candidate(found.place)).map_err(|fault| failed(&fault))?;
        Ok(Model { found, candidate })
    }
}

#[pymethods]
impl Model {
    /// The model in the JSON of a fit, a diagnosis, a verification or a device.
    #[staticmethod]
    fn from_json(json: &str) -> PyResult<Self> {
        Model::of(json)
    }

    /// The model itself, as in the JSON of results.
    #[getter]
    fn json(&self) -> PyResult<String> {
        serde_json::to_string(&self.found.model).map_err(|error| raised("failed", error))
    }

    /// Counts per revolution of the encoder; none where the result does not say.
    #[getter]
    fn counts_per_rev(&self) -> Option<f64> {
        self.found.counts_per_rev
    }

    /// The angle at each time, counts before the encoder rounds down, from rest unless a start is given.
    #[pyo3(signature = (time, command, *, enabled=None, counts_per_rev=None, start_counts=0.0, start_speed=0.0))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        time: PyReadonlyArray1<'py, f64>,
        command: PyReadonlyArray1<'py, f64>,
        enabled: Option<PyReadonlyArray1<'py, bool>>,
        counts_per_rev: Option<f64>,
        start_counts: f64,
        start_speed: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let counts_per_rev = counts_per_rev
            .or(self.found.counts_per_rev)
            .ok_or_else(|| {
                raised(
                    "usage",
                    "the result does not say how many counts a revolution has; give counts_per_rev",
                )
            })?;
        let commands = Commands {
            time_s: time.as_slice()?.to_vec(),
            command: command.as_slice()?.to_vec(),
            enabled: (enabled.as_ref())
                .map(|open| open.as_slice().map(<[bool]>::to_vec))
                .transpose()?,
            counts_per_rev,
        };
        let candidate = Candidate {
            start_speed,
            start_offset: start_counts,
            ..self.candidate
        };
        let method = self.found.model.method();
        let found = py.detach(|| response(&candidate, method, commands));
        let angle = found.map_err(|error| raised("usage", error))?;
        Ok(angle.into_pyarray(py))
    }

    /// The model in one of the formats of `servoid export`, as text.
    fn export(&self, format: &str) -> PyResult<String> {
        let chosen = Format::by_name(format).ok_or_else(|| {
            let names: Vec<&str> = servoid_results::export::FORMATS
                .iter()
                .map(|one| one.name)
                .collect();
            raised(
                "usage",
                format!(
                    "there is no format {format:?}; known are {}",
                    names.join(", ")
                ),
            )
        })?;
        let subject = Subject::new(&self.found, "servoid in Python", Side::Motor);
        let subject = subject.map_err(|error| raised("export", error))?;
        let written = (chosen.write)(&subject, &Options::default());
        Ok(written.map_err(|error| raised("export", error))?.text)
    }
}
