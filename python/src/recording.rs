//! A recording, from arrays or a file.

use super::error::raised;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use servoid_io::channel::Measured;
use servoid_io::input::{Arrays, Known, MotorFile, read_one, recording_of};
use servoid_io::recording::Recording as Read;
use std::path::{Path, PathBuf};

/// A recording of one motor: what was commanded, what the encoder read, and what is known of the motor.
#[pyclass(frozen, module = "servoid._servoid")]
pub(crate) struct Recording {
    pub(crate) read: Read,
    pub(crate) known: Known,
    name: Option<String>,
    /// What its reader has to say.
    remarks: Vec<String>,
}

/// What is known of the motor, as TOML text, beside or instead of the file that is named or lies beside the recording.
fn motor_of(
    text: Option<&str>,
    beside: Option<&Path>,
    named: Option<&Path>,
) -> PyResult<MotorFile> {
    let failed = |error: servoid_io::input::MotorFileError| raised("motor", error);
    match (text, named, beside) {
        (Some(text), _, _) => MotorFile::parse(text, "motor").map_err(failed),
        (None, Some(path), _) => MotorFile::read(path).map_err(failed),
        (None, None, Some(recording)) => {
            let found = MotorFile::find_beside(recording).map_err(failed)?;
            Ok(found.unwrap_or_default())
        }
        (None, None, None) => Ok(MotorFile::default()),
    }
}

#[pymethods]
impl Recording {
    #[new]
    #[pyo3(signature = (time, command, angle, *, current=None, temperature=None, supply=None, enabled=None, motor=None, source="arrays"))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        time: PyReadonlyArray1<'_, f64>,
        command: PyReadonlyArray1<'_, f64>,
        angle: PyReadonlyArray1<'_, f64>,
        current: Option<PyReadonlyArray1<'_, f64>>,
        temperature: Option<PyReadonlyArray1<'_, f64>>,
        supply: Option<PyReadonlyArray1<'_, f64>>,
        enabled: Option<PyReadonlyArray1<'_, bool>>,
        motor: Option<&str>,
        source: &str,
    ) -> PyResult<Self> {
        let motor = motor_of(motor, None, None)?;
        let told = [
            (Measured::Current, &current),
            (Measured::Temperature, &temperature),
            (Measured::Supply, &supply),
        ];
        let mut measured = Vec::new();
        for (channel, column) in told {
            if let Some(column) = column {
                measured.push((channel, column.as_slice()?));
            }
        }
        let arrays = Arrays {
            time: time.as_slice()?,
            command: command.as_slice()?,
            angle: angle.as_slice()?,
            measured: &measured,
            enabled: enabled
                .as_ref()
                .map(|column| column.as_slice())
                .transpose()?,
        };
        let read = recording_of(&arrays, source, &motor);
        Ok(Recording {
            read: read.map_err(|error| raised("recording", error))?,
            known: motor.known,
            name: motor.name,
            remarks: Vec::new(),
        })
    }

    /// What its reader took, repaired or left out, a sentence each.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.remarks.clone()
    }

    /// Times, s.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.read.time_s)
    }

    /// Commands, V (A behind a current loop).
    #[getter]
    fn command<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.read.command)
    }

    /// Readings, counts.
    #[getter]
    fn counts<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.read.counts)
    }

    /// Counts per revolution of the encoder.
    #[getter]
    fn counts_per_rev(&self) -> f64 {
        self.read.counts_per_rev
    }

    /// The file that it was read from, or `arrays`.
    #[getter]
    fn source(&self) -> &str {
        &self.read.source
    }

    /// The motor's name, if its owner gave one.
    #[getter]
    fn motor(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// The part from one time to another, s after the first sample.
    fn between(&self, start_s: f64, end_s: f64) -> PyResult<Self> {
        let part = self.read.between(start_s, end_s).ok_or_else(|| {
            raised(
                "usage",
                format!("from {start_s} to {end_s} s there are fewer than two samples; choose a longer span"),
            )
        })?;
        Ok(Recording {
            read: part,
            known: self.known.clone(),
            name: self.name.clone(),
            remarks: self.remarks.clone(),
        })
    }

    fn __len__(&self) -> usize {
        self.read.len()
    }

    fn __repr__(&self) -> String {
        format!(
            "<servoid.Recording {:?}: {} samples, {:.3} s>",
            self.read.source,
            self.read.len(),
            self.read.duration_s()
        )
    }
}

/// Reads a recording from a CSV file, with the `motor.toml` that lies beside it unless another is given.
#[pyfunction]
#[pyo3(signature = (path, *, motor_file=None, motor=None))]
pub(crate) fn read(
    py: Python<'_>,
    path: PathBuf,
    motor_file: Option<PathBuf>,
    motor: Option<&str>,
) -> PyResult<Recording> {
    let motor = motor_of(motor, Some(&path), motor_file.as_deref())?;
    let read = py.detach(|| read_one(&path, &motor));
    let mut reading = read.map_err(|error| raised("recording", error))?;
    let none = || {
        raised(
            "recording",
            format!("{}: holds no recording", path.display()),
        )
    };
    Ok(Recording {
        read: reading.recordings.pop().ok_or_else(none)?,
        known: reading.motor.known,
        name: reading.motor.name,
        remarks: reading.notes,
    })
}
