//! Constants of a model that are moved by hand.

use crate::error::Error;
use serde_json::{Map, Value, json};
use servoid_engine::problem::Candidate;
use shared::effects::EffectSet;

/// A slider goes from the value over this to the value times this.
const SLIDES: f64 = 3.0;

/// Constants of a model that a slider may move, with their ranges: those of the machine as its terminals show it, then
/// those of its effects.
pub(super) fn sliders(candidate: &Candidate) -> Value {
    let machine = &candidate.machine;
    let mut all = vec![
        ("machine.kb".to_owned(), machine.kb, "V*s/rad"),
        ("machine.inertia".to_owned(), machine.inertia, "V*s^2/rad"),
        ("machine.electrical".to_owned(), machine.electrical, "s"),
    ];
    if machine.damping > 0.0 {
        all.insert(
            1,
            ("machine.damping".to_owned(), machine.damping, "V*s/rad"),
        );
    }
    for (kind, values) in candidate.effects.iter() {
        for (parameter, &value) in kind.parameters().iter().zip(values) {
            let name = format!("{}.{}", kind.name(), parameter.name);
            all.push((name, value, parameter.quantity.unit()));
        }
    }
    let rows = all.into_iter().map(|(name, value, unit)| {
        let ends = [value / SLIDES, value * SLIDES];
        json!({
            "name": name, "value": value, "unit": unit,
            "low": ends[0].min(ends[1]), "high": ends[0].max(ends[1]),
        })
    });
    Value::Array(rows.collect())
}

/// A model with some of its constants moved.
///
/// # Errors
/// A name that the model does not have, or a value that is no number.
pub(super) fn moved(
    candidate: &Candidate,
    values: &Map<String, Value>,
) -> Result<Candidate, Error> {
    let mut left: Vec<&String> = values.keys().collect();
    let mut take = |name: &str, own: f64| -> Result<f64, Error> {
        let Some(value) = values.get(name) else {
            return Ok(own);
        };
        left.retain(|other| *other != name);
        (value.as_f64().filter(|x| x.is_finite()))
            .ok_or_else(|| Error::Usage(format!("{name}: `{value}` is no number")))
    };
    let mut moved = *candidate;
    let machine = &mut moved.machine;
    machine.kb = take("machine.kb", machine.kb)?;
    machine.damping = take("machine.damping", machine.damping)?;
    machine.inertia = take("machine.inertia", machine.inertia)?;
    machine.electrical = take("machine.electrical", machine.electrical)?;
    moved.effects = EffectSet::default();
    for (kind, values) in candidate.effects.iter() {
        let parameters = kind.parameters().iter().zip(values);
        let values: Vec<f64> = parameters
            .map(|(parameter, &own)| take(&format!("{}.{}", kind.name(), parameter.name), own))
            .collect::<Result<_, _>>()?;
        moved.effects.push(kind, &values)?;
    }
    match left.first() {
        None => Ok(moved),
        Some(name) => Err(Error::Usage(format!("the model has no constant `{name}`"))),
    }
}
