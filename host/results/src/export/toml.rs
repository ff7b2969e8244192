//! All parameters as TOML. The section `[known]` holds the physical ones as a `motor.toml` takes them, so that the next
//! recording of the motor begins with what this one found.

use super::comment::{head, marked};
use super::error::ExportError;
use super::options::Options;
use super::subject::Subject;
use super::table::rows;
use super::written::Written;
use ::toml::{Table, Value};

/// Facts of a motor file, with their names and units here.
const FACTS: [(&str, &str, &str); 6] = [
    ("resistance_ohm", "resistance", "ohm"),
    ("inductance_h", "inductance", "H"),
    ("kt_n_m_a", "kt", "N*m/A"),
    ("kb_v_s_rad", "kb", "V*s/rad"),
    ("inertia_kg_m2", "inertia", "kg*m^2"),
    ("viscous_n_m_s", "viscous", "N*m*s/rad"),
];

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let rows = rows(subject, &mut written);
    let mut top = Table::new();
    for (key, value) in [
        ("counts_per_rev", subject.counts_per_rev),
        ("supply_v", subject.supply_v),
    ] {
        if let Some(value) = value {
            top.insert(key.to_owned(), Value::Float(value));
        }
    }
    let mut parameters = Vec::new();
    for row in rows {
        let mut entry = Table::new();
        entry.insert("name".into(), Value::String(row.name));
        for (key, number) in [("value", row.value), ("std", row.std)] {
            if let Some(number) = number {
                entry.insert(key.into(), Value::Float(number));
            }
        }
        entry.insert("unit".into(), Value::String(row.unit));
        entry.insert("identifiable".into(), Value::Boolean(row.identifiable));
        entry.insert("side".into(), Value::String(row.side.to_owned()));
        parameters.push(Value::Table(entry));
    }
    let mut text = marked(&head(subject, &written), "# ");
    text += "\n";
    text += &top.to_string();
    let known = known(subject);
    if known.is_empty() {
        text += "\n# no physical parameter is determined: nothing to put under [known]\n";
    } else {
        text += "\n# for a motor.toml: a tolerance is the standard deviation as a part of the value\n[known]\n";
        text += &known;
    }
    let mut rest = Table::new();
    rest.insert("parameters".into(), Value::Array(parameters));
    text += "\n";
    text += &rest.to_string();
    written.text = text;
    Ok(written)
}

/// The lines of the section.
fn known(subject: &Subject) -> String {
    let mut out = String::new();
    for (key, name, unit) in FACTS {
        let found = subject
            .values
            .iter()
            .find(|v| v.name == name && v.unit == unit);
        let Some(found) = found.filter(|v| v.determined && v.value > 0.0) else {
            continue;
        };
        let tolerance = found.std.map(|std| std / found.value);
        out += &match tolerance.filter(|part| *part > 0.0 && *part < 1.0) {
            Some(part) => format!(
                "{key} = {{ value = {:?}, tolerance = {part:?} }}\n",
                found.value
            ),
            None => format!("{key} = {:?}\n", found.value),
        };
    }
    out
}
