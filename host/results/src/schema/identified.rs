//! What a fit, a diagnosis, a verification or a device found, from the JSON that it wrote.

use super::identified_fault::{ResultError, ResultFault};
use super::partial::{Found, Partial};
use super::{Estimate, Machine, Model, ModelParameter, device, diagnosis, fit, verification};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use servoid_io::recording::Drive;
use shared::effects::Kind;
use shared::motor::Response;
use std::fs;
use std::path::Path;

/// A model that was found, with how well each number of it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// What the file calls itself, as in `servoid.fit/1`.
    pub schema: String,
    /// The recording behind it.
    pub recording: Option<String>,
    /// What the command drove.
    pub drive: Drive,
    /// Supply, V.
    pub supply_v: Option<f64>,
    /// Encoder counts per revolution.
    pub counts_per_rev: Option<f64>,
    /// Sample interval, s.
    pub sample_s: Option<f64>,
    /// Whether the search came to its end.
    pub converged: bool,
    /// What a device said its numbers are good for.
    pub grade: Option<Graded>,
    /// Everything that was searched for, and what follows from it.
    pub parameters: Vec<Estimate>,
    /// The model itself, referred to the winding.
    pub model: Model,
    /// Where the model stands in the file.
    pub place: &'static str,
}

/// What a device said its numbers are good for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Graded {
    /// The grade.
    pub grade: device::Grade,
    /// Why it is no better.
    pub reason: Option<String>,
}

/// No number of a motor is as large, and what is computed from smaller ones stays finite.
const HUGE: f64 = 1e30;
/// Beyond this part of the value a standard deviation leaves the value open, as in a fit.
const OPEN: f64 = 0.5;

impl Identified {
    /// Reads the result in `path`; of a folder that `servoid device` wrote, its `device.json`.
    ///
    /// # Errors
    /// A file that cannot be read, is no such result, or holds no model; with its place.
    pub fn read(path: &Path) -> Result<Self, ResultError> {
        let path = if path.is_dir() {
            path.join(device::FILE)
        } else {
            path.to_path_buf()
        };
        fs::read_to_string(&path)
            .map_err(ResultFault::Io)
            .and_then(|text| Identified::parse(&text))
            .map_err(|fault| ResultError { path, fault })
    }

    /// Reads the text of a result.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(text: &str) -> Result<Self, ResultFault> {
        // First what it is, so that another file is refused by its name and not by a key.
        #[derive(Deserialize)]
        struct Named {
            schema: Option<String>,
        }
        let schema = json::<Named>(text)?.schema.unwrap_or_default();
        let file = || json::<Partial>(text);
        let result = match schema.as_str() {
            fit::SCHEMA => Identified::fitted(schema, file()?),
            diagnosis::SCHEMA => Identified::diagnosed(schema, file()?),
            verification::SCHEMA => {
                let diagnosis = file()?.diagnosis.ok_or(ResultFault::Undiagnosed)?;
                Identified::diagnosed(schema, *diagnosis)
            }
            device::SCHEMA => Identified::device(schema, file()?),
            _ => return Err(ResultFault::Schema(shown(&schema))),
        }?;
        result.check()
    }

    fn found(
        schema: String,
        set_up: Partial,
        found: Found,
        place: &'static str,
    ) -> Result<Self, ResultFault> {
        let drive = set_up.drive.as_deref();
        let drive = drive.ok_or(ResultFault::Missing("drive"))?;
        let drive = Drive::by_name(drive).ok_or_else(|| ResultFault::Drive(shown(drive)))?;
        Ok(Identified {
            schema,
            recording: set_up.recording,
            drive,
            supply_v: set_up.supply_v,
            counts_per_rev: set_up.counts_per_rev,
            sample_s: set_up.sample_s,
            converged: found.converged.unwrap_or(false),
            grade: None,
            parameters: (found.parameters).ok_or(ResultFault::Missing("parameters"))?,
            model: found.model.ok_or(ResultFault::Missing(place))?,
            place,
        })
    }

    fn fitted(schema: String, mut file: Partial) -> Result<Self, ResultFault> {
        let found = Found {
            parameters: file.parameters.take(),
            converged: file.converged,
            model: file.model.take(),
        };
        Identified::found(schema, file, found, "model")
    }

    fn diagnosed(schema: String, mut file: Partial) -> Result<Self, ResultFault> {
        if file.steady.is_some() {
            return Err(ResultFault::Steady);
        }
        let last = file.last.take();
        let last = last.ok_or(ResultFault::Missing("final"))?;
        Identified::found(schema, file, last, "final.model")
    }

    /// The device's three numbers say of a machine what voltage and angle can; its friction is in volts already.
    fn device(schema: String, file: Partial) -> Result<Self, ResultFault> {
        let outcome = file.outcome.ok_or(ResultFault::NotFitted)?;
        let grade = match (file.grade, file.failure) {
            (Some(grade), _) => Some(Graded {
                grade,
                reason: file.reason,
            }),
            // A device of before there were grades, or one that gave up.
            (None, failure) => failure.map(|failed| Graded {
                grade: device::Grade::No,
                reason: Some(failed.message),
            }),
        };
        let value = |name: &'static str| {
            let found = outcome.parameters.iter().find(|p| p.name == name);
            let value = found
                .map(|p| p.value)
                .ok_or(ResultFault::Missing("outcome.parameters"))?;
            super::number(name, value, value.is_finite(), "a finite number")
                .map_err(ResultFault::from)
        };
        let (gain, a1, electrical) = (value("gain")?, value("a1")?, value("electrical")?);
        super::number("gain", gain, gain > 0.0, "a positive number")?;
        let viscous = match outcome.parameters.iter().any(|p| p.name == "viscous_part") {
            false => 0.0,
            true => value("viscous_part")?,
        };
        let response = Response {
            gain,
            a1,
            a2: a1 * electrical,
        };
        let machine = response.machine_with_damping(viscous / gain);
        let mut model = Model {
            effects: Vec::new(),
            formulas: Vec::new(),
            machine: Machine::from(&machine),
            parameters: Vec::new(),
            start_speed_rad_s: 0.0,
            start_offset_counts: 0.0,
            steps_per_sample: 1,
            integrator: super::Integrator::Exact,
        };
        let mut parameters = Vec::new();
        for found in &outcome.parameters {
            let (name, unit, kind) = match found.name.as_str() {
                "gain" => ("gain".to_owned(), "rad/(s*V)".to_owned(), None),
                "electrical" => ("electrical_time_constant".to_owned(), "s".to_owned(), None),
                "coulomb" => (
                    "coulomb.torque".to_owned(),
                    found.unit.clone(),
                    Some(Kind::Coulomb),
                ),
                "load" => (
                    "load_torque.torque".to_owned(),
                    found.unit.clone(),
                    Some(Kind::LoadTorque),
                ),
                other => (other.to_owned(), found.unit.clone(), None),
            };
            if let Some(kind) = kind {
                model.effects.push(kind.name().to_owned());
                model.parameters.push(ModelParameter {
                    name: name.clone(),
                    value: found.value,
                    unit: unit.clone(),
                });
            }
            let known = |std: f64| std < OPEN * found.value.abs();
            parameters.push(Estimate {
                name,
                value: found.value,
                unit,
                std: found.std,
                identifiable: outcome.converged && found.std.is_some_and(known),
                spread: None,
                at_bound: false,
                usual: None,
                systematic: Vec::new(),
            });
        }
        Ok(Identified {
            schema,
            recording: None,
            drive: Drive::Voltage,
            supply_v: file.supply_v,
            counts_per_rev: file.counts_per_rev,
            sample_s: file.period_us.map(|us| us * 1e-6),
            converged: outcome.converged,
            grade,
            parameters,
            model,
            place: "outcome",
        })
    }

    /// Refuses numbers that no motor and no drive has.
    fn check(self) -> Result<Self, ResultFault> {
        for (key, value) in [
            ("supply_v", self.supply_v),
            ("counts_per_rev", self.counts_per_rev),
            ("sample_s", self.sample_s),
        ] {
            if let Some(value) = value {
                super::number(key, value, value > 0.0, "a positive number")?;
            }
        }
        for found in &self.parameters {
            // Names become those of other languages.
            let of_name = |c: char| c.is_ascii_alphanumeric() || "_.".contains(c);
            let begins = found.name.starts_with(|c: char| c.is_ascii_alphabetic());
            if !(begins && found.name.chars().all(of_name)) {
                return Err(ResultFault::Name(shown(&found.name)));
            }
            let key = format!("parameters, {}", shown(&found.name));
            super::number(
                &key,
                found.value,
                found.value.abs() < HUGE,
                "less than 1e30",
            )?;
            let std = found.std.unwrap_or(0.0);
            super::number(&key, std, std >= 0.0, "a standard deviation of at least 0")?;
        }
        let machine = self.model.candidate(self.place)?.machine;
        for value in [
            machine.kb,
            machine.damping,
            machine.inertia,
            machine.electrical,
        ] {
            let key = format!("{}.machine", self.place);
            super::number(&key, value, value < HUGE, "less than 1e30")?;
        }
        Ok(self)
    }
}

fn json<T: DeserializeOwned>(text: &str) -> Result<T, ResultFault> {
    serde_json::from_str(text).map_err(|error| {
        let (line, column, what) = super::json_place(&error);
        ResultFault::Json { line, column, what }
    })
}

/// Foreign text made fit for a line of a message.
fn shown(text: &str) -> String {
    text.chars().take(60).flat_map(char::escape_debug).collect()
}

#[cfg(test)]
mod tests;
