//! The models of a diagnosis, from the JSON that `servoid diagnose --json` writes: the only place that
//! knows its keys.

use super::hypothesis::{Hypothesis, Setup};
use crate::input::suggest::did_you_mean;
use serde::Deserialize;
use shared::effects::{Kind, MAX_EFFECTS};
use shared::motor::Machine;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A diagnosis that no plan can be made from: the file, and why.
#[derive(Debug, thiserror::Error)]
#[error("{}{fault}", .path.display())]
pub struct DiagnosisError {
    /// The file.
    pub path: PathBuf,
    /// What was seen in it and what to do.
    pub fault: DiagnosisFault,
}

/// Why no plan can be made from a diagnosis.
#[derive(Debug, thiserror::Error)]
pub enum DiagnosisFault {
    /// The system refused.
    #[error(": cannot be read: {0}; give the file that `servoid diagnose REC --json FILE` wrote")]
    Io(io::Error),
    /// It is no JSON, or a value has the wrong type. The message ends with line and column.
    #[error(
        ":{line}:{column}: {what}; give the file that `servoid diagnose REC --json FILE` wrote"
    )]
    Json {
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What was seen.
        what: String,
    },
    /// It is some other result.
    #[error(
        ": schema is `{0}`, needed is `{SCHEMA}`; give the file that `servoid diagnose REC --json FILE` wrote"
    )]
    Schema(String),
    /// A diagnosis that carries no models.
    #[error(
        ": has no `{0}`: it was written by an older servoid; run `servoid diagnose REC --json FILE` again"
    )]
    Missing(&'static str),
    /// A number that no motor and no drive has.
    #[error(": `{key}` is {value}, needed is {need}; run `servoid diagnose REC --json FILE` again")]
    Number {
        /// Where it stands.
        key: String,
        /// What was seen.
        value: f64,
        /// What would do.
        need: &'static str,
    },
    /// An effect that is not in the catalogue.
    #[error(": models[{model}] has the effect `{name}`, which is unknown; {remedy}")]
    Effect {
        /// Index of the model.
        model: usize,
        /// The effect.
        name: String,
        /// The nearest name, or all of them.
        remedy: String,
    },
    /// A parameter that is not there.
    #[error(
        ": models[{model}] lacks the parameter `{name}`; run `servoid diagnose REC --json FILE` again"
    )]
    Parameter {
        /// Index of the model.
        model: usize,
        /// The parameter, as in `coulomb.torque`.
        name: String,
    },
    /// A parameter in another unit than the model computes with.
    #[error(
        ": models[{model}] gives {name} in `{unit}`, needed is `{needed}` (torques in volts referred to the winding); \
         run `servoid diagnose REC --json FILE` again"
    )]
    Unit {
        /// Index of the model.
        model: usize,
        /// The parameter.
        name: String,
        /// Its unit in the file.
        unit: String,
        /// The unit that the model computes with.
        needed: &'static str,
    },
    /// Nothing to separate.
    #[error(
        ": holds only one model ({0}): nothing else of the catalogue explains the recording as well, so that there is \
         nothing to separate; to plan against a rival that you have in mind, use --between with its name instead"
    )]
    OneModel(String),
}

const SCHEMA: &str = "servoid.diagnosis/1";

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
mod tests {
    use super::*;

    const GOOD: &str = r#"{
  "schema": "servoid.diagnosis/1", "verdict": "missing_effects",
  "supply_v": 12.0, "no_load_rad_s": 700.0, "counts_per_rev": 2000, "sample_s": 0.001,
  "models": [
    {"effects": ["coulomb"], "role": "chosen",
     "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
     "parameters": [{"name": "coulomb.torque", "value": 0.48, "unit": "V"}]},
    {"effects": ["brush_drop"], "role": "alternative",
     "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
     "parameters": [{"name": "brush_drop.knee", "value": 0.1, "unit": "V"},
                    {"name": "brush_drop.voltage", "value": 0.5, "unit": "V"}]}
  ]
}"#;

    #[test]
    fn models_are_read_with_their_parameters_in_the_catalogue_s_order() {
        let (hypotheses, setup) = parse(GOOD).expect("a diagnosis");
        assert_eq!(setup.counts_per_rev, 2000.0);
        let names: Vec<String> = hypotheses.iter().map(Hypothesis::name).collect();
        assert_eq!(names, ["coulomb", "brush_drop"]);
        assert_eq!(hypotheses[0].values, [0.48]);
        assert_eq!(hypotheses[1].values, [0.5, 0.1]);
        assert_eq!(hypotheses[0].machine.electrical, 2.6e-4);
    }

    #[test]
    fn every_refusal_says_what_was_seen_and_what_to_do() {
        let cases = [
            (
                "\"schema\": \"servoid.diagnosis/1\"",
                "\"schema\": \"servoid.fit/1\"",
                "servoid.fit/1",
            ),
            (
                "\"schema\": \"servoid.diagnosis/1\"",
                "\"schema\": 1",
                ":2:",
            ),
            ("\"models\"", "\"model\"", "no `models`"),
            ("\"supply_v\"", "\"supply\"", "no `supply_v`"),
            ("\"sample_s\": 0.001", "\"sample_s\": 0", "`sample_s` is 0"),
            ("700.0", "-1", "`no_load_rad_s` is -1"),
            ("[\"coulomb\"]", "[\"colomb\"]", "did you mean `coulomb`?"),
            (
                "brush_drop.knee",
                "brush_drop.nee",
                "lacks the parameter `brush_drop.knee`",
            ),
            (
                "\"value\": 0.48, \"unit\": \"V\"",
                "\"value\": 0.48, \"unit\": \"N*m\"",
                "needed is `V`",
            ),
            (
                "\"inertia_v_s2_rad\": 4.3e-4",
                "\"inertia_v_s2_rad\": 0",
                "models[0].machine.inertia_v_s2_rad",
            ),
            ("\"kb_v_s_rad\": 0.017", "\"kb\": 0.017", "kb_v_s_rad"),
            (
                "[\"brush_drop\"]",
                "[\"coulomb\"]",
                "models[1] lacks the parameter `coulomb.torque`",
            ),
            ("0.001,", "0.001", ":4:"),
        ];
        for (from, to, says) in cases {
            let broken = GOOD.replacen(from, to, 1);
            assert_ne!(broken, GOOD, "{from}");
            let message = parse(&broken).expect_err(from).to_string();
            assert!(message.contains(says), "{to}: {message}");
        }
    }

    #[test]
    fn one_model_leaves_nothing_to_separate() {
        let start = GOOD
            .find(",\n    {\"effects\": [\"brush_drop\"]")
            .expect("it");
        let one = format!("{}]}}", &GOOD[..start]);
        let message = parse(&one).expect_err("one model").to_string();
        for word in ["only one model (coulomb)", "--between"] {
            assert!(message.contains(word), "{message}");
        }
    }
}
