//! Parquet files of pyarrow.

mod read;

use read::{assert_same, column, fixture, names, numeric, of, opened, rows, table};
use servoid_formats::{Format, FormatFault, Kind, open};
use std::ops::ControlFlow;

#[test]
fn a_table_has_its_columns_with_lists_and_structures_taken_apart() {
    let log = opened("parquet/flat.parquet");
    assert_eq!(log.format(), Format::Parquet);
    let (_, found) = table(&*log, "");
    assert_eq!(found.rows, Some(100));
    let columns: Vec<(&str, Kind)> = (found.columns.iter())
        .map(|column| (column.name.as_str(), column.kind))
        .collect();
    let expected = [
        ("t", Kind::Number),
        ("count", Kind::Number),
        ("big", Kind::Number),
        ("small", Kind::Number),
        ("half", Kind::Number),
        ("exact", Kind::Number),
        ("on", Kind::Flag),
        ("when", Kind::Time),
        ("day", Kind::Time),
        ("took", Kind::Number),
        ("label", Kind::Text),
        ("mode", Kind::Number),
        ("gap", Kind::Number),
        ("state[0]", Kind::Number),
        ("state[1]", Kind::Number),
        ("state[2]", Kind::Number),
        ("pair[0]", Kind::Number),
        ("pair[1]", Kind::Number),
        ("arm.angle", Kind::Number),
        ("arm.raw[0]", Kind::Number),
        ("arm.raw[1]", Kind::Number),
        ("image", Kind::Text),
    ];
    assert_eq!(columns, expected);
    let units = found.columns.iter().map(|column| column.unit.as_deref());
    let units: Vec<Option<&str>> = units.filter(Option::is_some).collect();
    assert_eq!(units, [Some("s"), Some("s")], "of t and of took");
}

fn holds_what_was_written(name: &str, count: usize) {
    let mut log = opened(name);
    let mut same = |column_name: &str, value: &dyn Fn(f64) -> f64| {
        let found = column(&mut *log, "", column_name);
        assert_same(&found, &of(count, value));
    };
    same("t", &|k| 0.25 * k);
    same("count", &|k| k - 7.0);
    same("big", &|k| 1_000_000_007.0 * k);
    same("small", &|k| k);
    same("half", &|k| 0.5 * (k % 64.0));
    same("exact", &|k| k / 4.0);
    same("on", &|k| f64::from(u8::from(k % 3.0 == 0.0)));
    same("when", &|k| 1_000_001.0 * k / 1e9);
    same("day", &|k| 86_400.0 * k);
    same("took", &|k| 1500.0 * k / 1e6);
    same("mode", &|k| k % 2.0);
    same("gap", &|k| {
        if k % 5.0 == 2.0 { f64::NAN } else { 0.125 * k }
    });
    same("state[2]", &|k| k + 0.75);
    same("pair[1]", &|k| 2.0 * k + 1.0);
    let but_one = |value: f64, k: f64| if k == 4.0 { f64::NAN } else { value };
    same("arm.angle", &|k| but_one(-0.5 * k, k));
    same("arm.raw[1]", &|k| but_one(k + 1.0, k));
}

#[test]
fn values_are_those_that_were_written() {
    holds_what_was_written("parquet/flat.parquet", 100);
    for codec in ["none", "gzip", "zstd", "lz4"] {
        holds_what_was_written(&format!("parquet/codec_{codec}.parquet"), 40);
    }
}

#[test]
fn columns_come_in_the_order_in_which_they_are_asked_for() {
    let mut log = opened("parquet/flat.parquet");
    let (found, read) = rows(&mut *log, 0, &[13, 0, 13]);
    read.unwrap();
    let state = of(100, |k| k + 0.25);
    assert_eq!(found, [state.clone(), of(100, |k| 0.25 * k), state]);
}

#[test]
fn pages_of_the_second_version_and_their_encodings_are_read() {
    let mut log = opened("parquet/encodings.parquet");
    assert_same(&column(&mut *log, "", "count"), &of(200, |k| k * k));
    assert_same(&column(&mut *log, "", "angle"), &of(200, |k| 0.25 * k));
}

#[test]
fn a_file_of_recordings_has_a_table_a_row() {
    let mut log = opened("parquet/recordings.parquet");
    let tables: Vec<&str> = log
        .tables()
        .iter()
        .map(|table| table.name.as_str())
        .collect();
    assert_eq!(tables, ["left", "right", "row 2"]);
    let expected = [
        "t_s",
        "voltage_v",
        "angle_counts",
        "current_a",
        "enabled",
        "counts_per_rev",
    ];
    assert_eq!(names(&log.tables()[1]), expected);
    assert_same(&column(&mut *log, "left", "t_s"), &of(5, |k| 0.001 * k));
    assert_same(
        &column(&mut *log, "right", "voltage_v"),
        &of(8, |k| 0.5 * k + 8.0),
    );
    assert_same(
        &column(&mut *log, "row 2", "angle_counts"),
        &of(6, |k| 10.0 * k - 6.0),
    );
    assert_same(
        &column(&mut *log, "right", "current_a"),
        &of(8, |_| f64::NAN),
    );
    assert_same(
        &column(&mut *log, "right", "counts_per_rev"),
        &of(8, |_| 2048.0),
    );
    let on = of(6, |k| f64::from(u8::from(k % 2.0 == 0.0)));
    assert_same(&column(&mut *log, "row 2", "enabled"), &on);
}

#[test]
fn lists_of_no_length_of_their_own_are_filled_up() {
    let mut log = opened("parquet/ragged.parquet");
    assert_eq!(
        names(&log.tables()[0]),
        ["t", "hits[0]", "hits[1]", "hits[2]"]
    );
    let second = of(20, |k| if k % 4.0 < 2.0 { f64::NAN } else { 1.0 });
    assert_same(&column(&mut *log, "", "hits[1]"), &second);
}

#[test]
fn a_file_without_rows_has_columns() {
    let mut log = opened("parquet/empty.parquet");
    assert_eq!(log.tables()[0].rows, Some(0));
    assert_eq!(column(&mut *log, "", "angle"), [0.0; 0]);
}

#[test]
fn reading_ends_when_no_more_is_wanted() {
    let mut log = opened("parquet/flat.parquet");
    let mut batches = 0;
    let read = log.read(0, &[0], &mut |_| {
        batches += 1;
        ControlFlow::Break(())
    });
    read.unwrap();
    assert_eq!(batches, 1);
}

#[test]
fn texts_and_what_is_not_there_are_errors_with_their_place() {
    let mut log = opened("parquet/flat.parquet");
    let mut fault = |table, column| {
        let (_, read) = rows(&mut *log, table, &[column]);
        read.unwrap_err()
    };
    let text = fault(0, 10);
    assert!(
        matches!(text.fault, FormatFault::Text) && text.place == "label",
        "{text}"
    );
    assert!(matches!(fault(0, 99).fault, FormatFault::Absent));
    assert!(matches!(fault(7, 0).fault, FormatFault::Absent));
}

#[test]
fn a_file_that_was_cut_short_says_so() {
    let whole = std::fs::read(fixture("parquet/flat.parquet")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.parquet");
    std::fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    let Err(error) = open(&path) else {
        panic!("it has no footer")
    };
    assert!(
        matches!(error.fault, FormatFault::CutShort { .. }),
        "{error}"
    );
}

#[test]
fn a_dictionary_that_claims_more_than_its_page_holds_is_refused() {
    let mut bytes = std::fs::read(fixture("parquet/flat.parquet")).unwrap();
    // The head of the first dictionary ends with its 32 values; signs are in the last bit.
    let said = [0x4c, 0x15, 2 * 32];
    let at = bytes.windows(3).position(|bytes| bytes == said).unwrap();
    bytes[at + 2] = 2 * 63;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("claims.parquet");
    std::fs::write(&path, bytes).unwrap();
    let mut log = open(&path).unwrap().unwrap();
    for _ in 0..2 {
        let all = numeric(&log.tables()[0]);
        let error = rows(&mut *log, 0, &all).1.unwrap_err();
        assert!(error.to_string().contains("claims more"), "{error}");
    }
}
