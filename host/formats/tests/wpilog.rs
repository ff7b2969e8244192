//! A data log of WPILib's own library.

mod read;

use read::{assert_same, column, names, of, opened, rows, table};
use servoid_formats::{Format, FormatFault, Kind};

#[test]
fn entries_are_tables_of_times_and_values() {
    let mut log = opened("wpilog/robot.wpilog");
    assert_eq!(log.format(), Format::Wpilog);
    let time = of(30, |k| 5_001.0 * k / 1e6);
    let mut same = |entry: &str, name: &str, value: &dyn Fn(f64) -> f64| {
        // Times count from the log's first record.
        let mut own = column(&mut *log, entry, "timestamp");
        let first = own.first().copied().unwrap_or(f64::NAN);
        assert!((0.0..1e-3).contains(&first), "{entry}: {first}");
        own.iter_mut()
            .for_each(|moment| *moment = ((*moment - first) * 1e6).round() / 1e6);
        assert_same(&own, &time);
        assert_same(&column(&mut *log, entry, name), &of(30, value));
    };
    same("/arm/counts", "value", &|k| -3.0 * k);
    same("/arm/current", "value", &|k| 0.5 * k);
    same("/arm/enabled", "value", &|k| 1.0 - k % 2.0);
    same("/arm/raw", "value[1]", &|k| 2.0 * k);
    same("/arm/raw", "value[2]", &|k| {
        if k % 2.0 == 1.0 { f64::NAN } else { 3.0 * k }
    });
    same("/arm/flags", "value[0]", &|k| 1.0 - k % 2.0);
    same("/arm/whole", "value[1]", &|k| -k);
    same("/arm/half", "value[0]", &|k| 0.5 * k);
    same("/arm/pose", "x", &|k| 1.5 * k);
    same("/arm/pose", "turns", &|k| -k);
    same("/arm/pose", "rotation.value", &|k| 0.125 * k);
    same("/arm/pose", "on", &|k| f64::from(u8::from(k % 3.0 == 0.0)));
    same("/arm/poses", "value[1].rotation.value", &|_| 2.0);
    same("/arm/poses", "value[0].x", &|k| 1.5 * k);
}

#[test]
fn tables_have_rows_kinds_and_units() {
    let log = opened("wpilog/robot.wpilog");
    let (_, voltage) = table(&*log, "/arm/voltage");
    assert_eq!(names(voltage), ["timestamp", "value"]);
    assert_eq!(voltage.rows, Some(31), "the entry was opened twice");
    let described: Vec<(Kind, Option<&str>)> = voltage
        .columns
        .iter()
        .map(|column| (column.kind, column.unit.as_deref()))
        .collect();
    assert_eq!(described, [(Kind::Time, None), (Kind::Number, Some("V"))]);
    let (_, enabled) = table(&*log, "/arm/enabled");
    assert_eq!(enabled.columns[1].kind, Kind::Flag);
    for text in ["sysid-test-state-arm", "/arm/words", "/arm/opaque"] {
        let (_, found) = table(&*log, text);
        assert_eq!(
            (found.rows, found.columns[1].kind),
            (Some(3), Kind::Text),
            "{text}"
        );
    }
}

#[test]
fn an_entry_that_was_opened_again_goes_on() {
    let mut log = opened("wpilog/robot.wpilog");
    let mut expected = of(30, |k| 0.25 * k);
    expected.push(99.0);
    assert_same(&column(&mut *log, "/arm/voltage", "value"), &expected);
}

#[test]
fn texts_have_times_and_no_numbers() {
    let mut log = opened("wpilog/robot.wpilog");
    let (number, _) = table(&*log, "sysid-test-state-arm");
    let moments = column(&mut *log, "sysid-test-state-arm", "timestamp");
    assert_same(&moments, &of(3, |k| 50_010.0 * k / 1e6));
    let (_, read) = rows(&mut *log, number, &[1]);
    assert!(matches!(read.unwrap_err().fault, FormatFault::Text));
}
