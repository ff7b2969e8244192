//! What Simulink writes in the format "Structure With Time": `time`, `signals(k).values` and
//! `signals(k).label`.

use super::value::{Fields, Numbers, Value};
use crate::log::Kind;
use crate::together::{self, Array};
use std::collections::HashMap;

/// The field with the times, in seconds.
pub(crate) const TIME: &str = "time";
/// The field with the signals.
pub(crate) const SIGNALS: &str = "signals";
const VALUES: &str = "values";
const LABEL: &str = "label";

/// The signals of such a structure with their times; `None` for another struct.
pub(crate) fn signals(fields: &Fields) -> Option<Vec<Array>> {
    let Value::Struct(signals) = get(fields, SIGNALS)? else {
        return None;
    };
    let mut labels: HashMap<&str, usize> = HashMap::new();
    for label in signals.iter().filter_map(|signal| label(signal)) {
        *labels.entry(label).or_default() += 1;
    }
    let mut arrays = Vec::new();
    if let Some(Value::Numbers(times)) = get(fields, TIME) {
        arrays.extend(array(TIME.to_owned(), Kind::Time, times));
    }
    for (at, signal) in signals.iter().enumerate() {
        let Value::Numbers(values) = get(signal, VALUES)? else {
            return None;
        };
        let label = label(signal).filter(|label| labels.get(label) == Some(&1));
        let name = label.map_or_else(|| format!("{SIGNALS}[{at}]"), str::to_owned);
        arrays.push(array(name, values.kind, values)?);
    }
    Some(arrays)
}

fn get<'f>(fields: &'f Fields, name: &str) -> Option<&'f Value> {
    let mut all = fields.iter();
    all.find_map(|(field, value)| (field == name).then_some(value))
}

fn label(signal: &Fields) -> Option<&str> {
    match get(signal, LABEL)? {
        Value::Text(label) if !label.is_empty() && label != TIME => Some(label),
        _ => None,
    }
}

fn array(name: String, kind: Kind, numbers: &Numbers) -> Option<Array> {
    Some(Array {
        name,
        shape: together::shape(&numbers.axes)?,
        kind,
        unit: None,
        id: numbers.id,
    })
}
