//! A Modelica record (Modelica Standard Library 4, `Modelica.Units.SI`). Numbers whose unit has a type there take it; others
//! are a `Real` with the unit in Modelica's spelling.

use super::comment::{head, marked, plain};
use super::error::ExportError;
use super::law_code::functions;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use servoid_formula::Language;
use std::collections::HashSet;

/// Types of the library by our unit.
const TYPES: [(&str, &str); 11] = [
    ("V", "Voltage"),
    ("ohm", "Resistance"),
    ("H", "Inductance"),
    ("N*m", "Torque"),
    ("N*m/A", "ElectricalTorqueConstant"),
    ("V*s/rad", "ElectricalTorqueConstant"),
    ("kg*m^2", "Inertia"),
    ("N*m*s/rad", "RotationalDampingConstant"),
    ("rad/s", "AngularVelocity"),
    ("s", "Time"),
    ("rad", "Angle"),
];

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let mut names = HashSet::new();
    let mut body = String::new();
    let numbers = subject.values.iter().map(|v| {
        let std = v.std.filter(|std| *std > 0.0);
        let about = std.map_or_else(String::new, |std| format!(", standard deviation {std:.2e}"));
        (
            v.name.as_str(),
            v.determined.then_some(v.value),
            v.unit.as_str(),
            about,
        )
    });
    let set_up = [
        ("supply", subject.supply_v, "V", String::new()),
        (
            "counts_per_rev",
            subject.counts_per_rev,
            "count/rev",
            String::new(),
        ),
    ];
    for (name, value, unit, about) in numbers.chain(set_up) {
        let shown = subject.unit_shown(unit);
        let Some(value) = value else {
            written.lacks(name, "not determined by this recording");
            continue;
        };
        let stem = name.replace('.', "_");
        let mut to = stem.clone();
        let mut again = 2;
        while !names.insert(to.clone()) {
            to = format!("{stem}_{again}");
            again += 1;
        }
        written.map(name, &to, &shown);
        let (kind, own) = kind(unit, shown == unit);
        body += &format!(
            "  parameter {kind} {to}{own} = {value:?} \"{name}, {shown}{about}, {} side\";\n",
            subject.side.name()
        );
    }
    if names.is_empty() || !names.contains("gain") && !names.contains("inertia") {
        subject.needs_response("modelica")?;
    }
    let mut equations = String::new();
    for term in &subject.terms {
        let kind = term.kind.description();
        if term.determined.contains(&true) {
            equations += &format!("  // {}: {}\n", kind.name, plain(kind.equation));
            written.remarks.push(format!(
                "{}: the record holds its numbers, not its equation",
                kind.name
            ));
        } else {
            written.lacks(kind.name, "none of its parameters is determined");
        }
    }
    let mut text = marked(&head(subject, &written), "// ");
    text += "record Motor \"a motor identified by servoid\"\n  extends Modelica.Icons.Record;\n";
    text += &equations;
    text += &body;
    text += &functions(subject, Language::Modelica, "  // ", &mut written);
    text += "end Motor;\n";
    written.text = text;
    Ok(written)
}

/// Type of a number in `unit`, and what stands behind its name; `physical` is false behind a current loop.
fn kind(unit: &str, physical: bool) -> (String, String) {
    let known = TYPES.iter().find(|(known, _)| *known == unit);
    let plain = "Real".to_owned();
    match known.filter(|_| physical) {
        Some((_, name)) => (format!("Modelica.Units.SI.{name}"), String::new()),
        None if !physical || unit.contains("rev") || unit == "1" => (plain, String::new()),
        None => {
            let unit = unit.replace('*', ".").replace('^', "");
            (plain, format!("(unit=\"{unit}\")"))
        }
    }
}
