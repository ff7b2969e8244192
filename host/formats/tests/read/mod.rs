//! Reads fixtures whole, which are small.
// Each program of tests takes some of it.
#![allow(dead_code)]

use servoid_formats::{FormatError, Kind, Log, Table, open};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// The fixture at that path.
pub fn fixture(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    folder.join(name)
}

/// The fixture, open.
pub fn opened(name: &str) -> Box<dyn Log> {
    let log = open(&fixture(name)).unwrap();
    log.unwrap()
}

/// The table of that name.
pub fn table<'l>(log: &'l dyn Log, name: &str) -> (usize, &'l Table) {
    let mut tables = log.tables().iter().enumerate();
    tables.find(|(_, table)| table.name == name).unwrap()
}

/// The names of its columns.
pub fn names(table: &Table) -> Vec<&str> {
    let columns = table.columns.iter();
    columns.map(|column| column.name.as_str()).collect()
}

/// Its columns that hold numbers.
pub fn numeric(table: &Table) -> Vec<usize> {
    let columns = table.columns.iter().enumerate();
    let numeric = columns.filter(|(_, column)| column.kind != Kind::Text);
    numeric.map(|(index, _)| index).collect()
}

/// All rows of some columns, as far as they can be read.
pub fn rows(
    log: &mut dyn Log,
    table: usize,
    columns: &[usize],
) -> (Vec<Vec<f64>>, Result<(), FormatError>) {
    let mut out = vec![Vec::new(); columns.len()];
    let read = log.read(table, columns, &mut |some| {
        assert_eq!(some.len(), columns.len());
        for (all, some) in out.iter_mut().zip(some) {
            assert!(!some.is_empty() && some.len() <= 4096);
            all.extend_from_slice(some);
        }
        ControlFlow::Continue(())
    });
    (out, read)
}

/// All rows of the column of that name.
pub fn column(log: &mut dyn Log, of: &str, name: &str) -> Vec<f64> {
    let (number, found) = table(log, of);
    let at = names(found).iter().position(|found| *found == name);
    let at = at.unwrap_or_else(|| panic!("{of} has no {name}, but {:?}", names(found)));
    let (mut rows, read) = rows(log, number, &[at]);
    read.unwrap();
    rows.remove(0)
}

/// What a formula makes of the first numbers.
pub fn of(rows: usize, value: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..rows).map(|k| value(k as f64)).collect()
}

/// Equal to the last bit, gaps among them.
#[track_caller]
pub fn assert_same(found: &[f64], expected: &[f64]) {
    let bits = |values: &[f64]| -> Vec<u64> {
        let bits = |value: &f64| {
            if value.is_nan() {
                0
            } else {
                (value + 0.0).to_bits()
            }
        };
        values.iter().map(bits).collect()
    };
    assert_eq!(bits(found), bits(expected), "{found:?} is not {expected:?}");
}
