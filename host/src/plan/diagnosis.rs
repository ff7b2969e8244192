//! The models of a diagnosis, from the JSON that `servoid diagnose --json` writes: the only place that
//! knows its keys.

use super::diagnosis_error::{DiagnosisError, DiagnosisFault};
use super::hypothesis::{Hypothesis, Setup};
use crate::input::suggest::did_you_mean;
use serde::Deserialize;
use shared::effects::{Kind, MAX_EFFECTS};
use shared::motor::Machine;
use std::fs;
use std::path::Path;

/// What a diagnosis calls itself.
pub(super) const SCHEMA: &str = "servoid.diagnosis/1";

/// What is read of the file; other keys are ignored.
#[derive(Deserialize)]
struct Diagnosis {
    schema: Option<String>,
    models: Option<Vec<Model>>,
    supply_v: Option<f64>,
    no_load_rad_s: Option<f64>,
    counts_per_rev: Option<f64>,
    sample_s: Option<f64>,
}

#[derive(Deserialize)]
struct Model {
    effects: Vec<String>,
    machine: MachineKeys,
    #[serde(default)]
    parameters: Vec<Parameter>,
}

#[derive(Deserialize)]
struct MachineKeys {
    kb_v_s_rad: f64,
    damping_v_s_rad: f64,
    inertia_v_s2_rad: f64,
    electrical_s: f64,
}

#[derive(Deserialize)]
struct Parameter {
    name: String,
    value: f64,
    unit: String,
}

/// The models of the diagnosis in `path` that differ in their effects, and what they run on.
///
/// # Errors
/// A file that cannot be read, is no diagnosis, or leaves nothing to separate.
pub fn read(path: &Path) -> Result<(Vec<Hypothesis>, Setup), DiagnosisError> {
    fs::read_to_string(path)
        .map_err(DiagnosisFault::Io)
        .and_then(|text| parse(&text))
        .map_err(|fault| DiagnosisError {
            path: path.into(),
            fault,
        })
}

fn parse(text: &str) -> Result<(Vec<Hypothesis>, Setup), DiagnosisFault> {
    let diagnosis: Diagnosis = serde_json::from_str(text).map_err(json_fault)?;
    match diagnosis.schema.as_deref() {
        Some(SCHEMA) => {}
        other => return Err(DiagnosisFault::Schema(other.unwrap_or("missing").into())),
    }
    let models = (diagnosis.models.as_ref()).ok_or(DiagnosisFault::Missing("models"))?;
    let setup = setup(&diagnosis)?;
    let mut hypotheses: Vec<Hypothesis> = Vec::with_capacity(models.len());
    for (index, model) in models.iter().enumerate() {
        let found = hypothesis(index, model)?;
        // Of models with the same effects the first was chosen.
        let known = |h: &Hypothesis| h.contains(&found) && found.contains(h);
        if !hypotheses.iter().any(known) {
            hypotheses.push(found);
        }
    }
    match &hypotheses[..] {
        [] => Err(DiagnosisFault::Missing("models")),
        [only] => Err(DiagnosisFault::OneModel(only.name())),
        _ => Ok((hypotheses, setup)),
    }
}

fn json_fault(error: serde_json::Error) -> DiagnosisFault {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    DiagnosisFault::Json {
        line: error.line(),
        column: error.column(),
        what: text.strip_suffix(&place).unwrap_or(&text).to_owned(),
    }
}

fn setup(diagnosis: &Diagnosis) -> Result<Setup, DiagnosisFault> {
    let positive = |key: &'static str, value: Option<f64>| {
        let value = value.ok_or(DiagnosisFault::Missing(key))?;
        number(key, value, value > 0.0, "a positive number")
    };
    Ok(Setup {
        supply_v: positive("supply_v", diagnosis.supply_v)?,
        no_load_rad_s: positive("no_load_rad_s", diagnosis.no_load_rad_s)?,
        counts_per_rev: positive("counts_per_rev", diagnosis.counts_per_rev)?,
        sample_s: positive("sample_s", diagnosis.sample_s)?,
    })
}

fn number(key: &str, value: f64, good: bool, need: &'static str) -> Result<f64, DiagnosisFault> {
    if good && value.is_finite() {
        return Ok(value);
    }
    Err(DiagnosisFault::Number {
        key: key.to_owned(),
        value,
        need,
    })
}

fn hypothesis(index: usize, model: &Model) -> Result<Hypothesis, DiagnosisFault> {
    let mut effects = Vec::with_capacity(model.effects.len());
    let mut values = Vec::new();
    for name in &model.effects {
        let kind = kind(index, name)?;
        for parameter in kind.description().parameters {
            let name = format!("{name}.{}", parameter.name);
            values.push(value(index, model, name, parameter.quantity.unit())?);
        }
        effects.push(kind);
    }
    let many = effects.len() as f64;
    let key = format!("models[{index}].effects");
    number(
        &key,
        many,
        effects.len() <= MAX_EFFECTS,
        "at most 8 effects",
    )?;
    Ok(Hypothesis {
        effects,
        machine: machine(index, &model.machine)?,
        values,
    })
}

fn kind(model: usize, name: &str) -> Result<Kind, DiagnosisFault> {
    Kind::by_name(name).ok_or_else(|| {
        let known: Vec<&str> = Kind::ALL.iter().map(|kind| kind.name()).collect();
        DiagnosisFault::Effect {
            model,
            name: name.to_owned(),
            remedy: did_you_mean(name, &known),
        }
    })
}

fn value(
    index: usize,
    model: &Model,
    name: String,
    needed: &'static str,
) -> Result<f64, DiagnosisFault> {
    let found = model.parameters.iter().find(|known| known.name == name);
    match found {
        None => Err(DiagnosisFault::Parameter { model: index, name }),
        Some(known) if known.unit != needed => Err(DiagnosisFault::Unit {
            model: index,
            name,
            unit: known.unit.clone(),
            needed,
        }),
        Some(known) => Ok(known.value),
    }
}

fn machine(index: usize, keys: &MachineKeys) -> Result<Machine<f64>, DiagnosisFault> {
    let key = |name: &str| format!("models[{index}].machine.{name}");
    let at_least_zero = |name: &str, value: f64| {
        number(&key(name), value, value >= 0.0, "zero or a positive number")
    };
    let inertia = keys.inertia_v_s2_rad;
    let kb = keys.kb_v_s_rad;
    Ok(Machine {
        kb: number(&key("kb_v_s_rad"), kb, kb > 0.0, "a positive number")?,
        damping: at_least_zero("damping_v_s_rad", keys.damping_v_s_rad)?,
        inertia: number(
            &key("inertia_v_s2_rad"),
            inertia,
            inertia > 0.0,
            "a positive number",
        )?,
        electrical: at_least_zero("electrical_s", keys.electrical_s)?,
    })
}

#[cfg(test)]
mod tests;
