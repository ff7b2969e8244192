//! Fixtures against what their scripts wrote beside them.
// Each program of tests takes some of it.
#![allow(dead_code)]

#[path = "../read/mod.rs"]
mod read;

use serde_json::Value;
use servoid_formats::{FormatError, FormatFault, Kind, Log, Table, open};
use std::path::{Path, PathBuf};

/// The folder of fixtures.
pub use read::fixture as folder;

/// The fixtures of a folder, in the order of their names.
pub fn fixtures(folder: &Path) -> Vec<PathBuf> {
    let files = std::fs::read_dir(folder).unwrap();
    let files = files.map(|file| file.unwrap().path());
    let mut files: Vec<PathBuf> = files
        .filter(|file| !file.ends_with("expected.json"))
        .collect();
    files.sort();
    files
}

/// All rows of some columns.
pub fn rows(
    log: &mut dyn Log,
    table: usize,
    columns: &[usize],
) -> Result<Vec<Vec<f64>>, FormatError> {
    let (rows, read) = read::rows(log, table, columns);
    read.map(|()| rows)
}

/// Every fixture of a folder is as its script expects it.
pub fn hold(name: &str) {
    let folder = folder(name);
    let text = std::fs::read_to_string(folder.join("expected.json")).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let expected = expected.as_object().unwrap();
    let files = fixtures(&folder);
    assert_eq!(files.len(), expected.len(), "fixtures of {name}");
    for file in files {
        let name = file.file_name().unwrap().to_str().unwrap();
        holds(&file, &expected[name]);
    }
}

fn holds(file: &Path, expected: &Value) {
    let shown = file.display();
    let opened = open(file);
    if let Some(what) = expected.get("error") {
        let error = opened.err().expect("an error").to_string();
        assert!(error.contains(what.as_str().unwrap()), "{error}");
        assert!(error.contains(&*file.to_string_lossy()), "{error}");
        return;
    }
    let mut log = opened.unwrap().unwrap();
    assert_eq!(format!("{:?}", log.format()), expected["format"], "{shown}");
    let facts: serde_json::Map<String, Value> = log
        .facts()
        .iter()
        .map(|(name, value)| (name.clone(), Value::from(value.as_str())))
        .collect();
    assert_eq!(Value::Object(facts), expected["facts"], "{shown}");
    let tables = log.tables().to_vec();
    let names: Vec<&str> = tables.iter().map(|table| &*table.name).collect();
    let expected = expected["tables"].as_array().unwrap();
    let wanted: Vec<&str> = expected
        .iter()
        .map(|table| table["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, wanted, "tables of {shown}");
    for (at, (table, expected)) in tables.iter().zip(expected).enumerate() {
        match expected.get("unread") {
            Some(what) => unread(&mut *log, at, what.as_str().unwrap()),
            None => same(
                &mut *log,
                at,
                table,
                expected["columns"].as_array().unwrap(),
            ),
        }
    }
}

fn unread(log: &mut dyn Log, table: usize, what: &str) {
    let error = rows(log, table, &[0]).unwrap_err();
    assert!(matches!(error.fault, FormatFault::Unsupported { .. }));
    assert!(error.to_string().contains(what), "{error}");
}

fn same(log: &mut dyn Log, at: usize, table: &Table, expected: &[Value]) {
    let described: Vec<Value> = table
        .columns
        .iter()
        .map(|column| serde_json::json!([column.name, format!("{:?}", column.kind), column.unit]))
        .collect();
    let wanted: Vec<Value> = expected
        .iter()
        .map(|column| serde_json::json!([column["name"], column["kind"], column["unit"]]))
        .collect();
    assert_eq!(described, wanted, "columns of {}", table.name);
    let mut numeric = Vec::new();
    for (column, found) in table.columns.iter().enumerate() {
        if found.kind == Kind::Text {
            let error = rows(log, at, &[column]).unwrap_err();
            assert!(matches!(error.fault, FormatFault::Text), "{error}");
        } else {
            numeric.push(column);
        }
    }
    // In the opposite order, too, and one for itself.
    let reversed: Vec<usize> = numeric.iter().rev().copied().collect();
    let all = rows(log, at, &numeric).unwrap();
    let mut others = rows(log, at, &reversed).unwrap();
    others.reverse();
    for ((&column, values), other) in numeric.iter().zip(&all).zip(&others) {
        let wanted = values_of(&expected[column]);
        let name = &table.columns[column].name;
        equal(values, &wanted, name);
        equal(other, &wanted, name);
        equal(&rows(log, at, &[column, column]).unwrap()[1], &wanted, name);
        assert_eq!(
            table.rows,
            Some(wanted.len() as u64),
            "rows of {}",
            table.name
        );
    }
    assert!(matches!(
        rows(log, at, &[table.columns.len()]).unwrap_err().fault,
        FormatFault::Absent
    ));
}

fn values_of(column: &Value) -> Vec<f64> {
    if let Some(ramp) = column.get("ramp") {
        let [rows, step, modulo] = [0, 1, 2].map(|at| ramp[at].as_u64().unwrap());
        return (0..rows).map(|row| (row * step % modulo) as f64).collect();
    }
    let values = column["values"].as_array().unwrap().iter();
    let value = |value: &Value| match value {
        Value::Null => f64::NAN,
        Value::String(text) => text.parse().unwrap(),
        number => number.as_f64().unwrap(),
    };
    values.map(value).collect()
}

fn equal(values: &[f64], wanted: &[f64], name: &str) {
    assert_eq!(values.len(), wanted.len(), "rows of {name}");
    for (row, (value, wanted)) in values.iter().zip(wanted).enumerate() {
        let same = value == wanted || (value.is_nan() && wanted.is_nan());
        assert!(same, "row {row} of {name}: {value} and not {wanted}");
    }
}
