//! The models of a diagnosis, from the JSON that `servoid diagnose --json` writes.

use super::diagnosis::{Alternative, SCHEMA};
use super::hypotheses_fault::{DiagnosisError, DiagnosisFault};
use super::model::{define, terms};
use super::partial::Alike;
use super::{ModelFault, json_place, number};
use servoid_identify::plan::{Hypothesis, Setup};
use servoid_io::recording::Drive;
use std::fs;
use std::path::Path;

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
    let diagnosis: Alike = serde_json::from_str(text).map_err(json_fault)?;
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
    let (line, column, what) = json_place(&error);
    DiagnosisFault::Json { line, column, what }
}

fn setup(diagnosis: &Alike) -> Result<Setup, DiagnosisFault> {
    let positive = |key: &'static str, value: Option<f64>| {
        let value = value.ok_or(DiagnosisFault::Missing(key))?;
        number(key, value, value > 0.0, "a positive number").map_err(DiagnosisFault::from)
    };
    Ok(Setup {
        supply_v: positive("supply_v", diagnosis.supply_v)?,
        no_load_rad_s: positive("no_load_rad_s", diagnosis.no_load_rad_s)?,
        counts_per_rev: positive("counts_per_rev", diagnosis.counts_per_rev)?,
        sample_s: positive("sample_s", diagnosis.sample_s)?,
    })
}

fn hypothesis(index: usize, model: &Alternative) -> Result<Hypothesis, ModelFault> {
    let place = format!("models[{index}]");
    let (mut effects, mut values) = (Vec::new(), Vec::new());
    define(&model.formulas, &place)?;
    // A plan is of voltages.
    let drives = [Drive::Voltage];
    for (kind, own) in terms(&model.effects, &model.parameters, &place, &drives)? {
        effects.push(kind);
        values.extend(own);
    }
    let machine = model.machine.machine(&place)?;
    let key = format!("{place}.machine.kb_v_s_rad");
    number(&key, machine.kb, machine.kb > 0.0, "a positive number")?;
    Ok(Hypothesis {
        effects,
        machine,
        values,
    })
}

#[cfg(test)]
mod tests;
