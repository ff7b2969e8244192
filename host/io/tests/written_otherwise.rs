//! One recording, written as programs and people write it: read, it is always the same.

use servoid_io::input::{
    MotorFile, PRESETS, read_recording, read_recordings, read_recordings_with,
};
use servoid_io::recording::Recording;
use std::cell::Cell;
use std::fmt::Write;
use std::fs;
use std::path::Path;

const ROWS: usize = 60;

/// Time in ms, volts and counts of a row.
fn row(k: usize) -> (f64, f64, i64) {
    let volts = if k % 20 < 10 { 1.5 } else { -2.25 };
    (k as f64 * 2.0, volts, (k * k) as i64 % 97)
}

fn motor(more: &str) -> MotorFile {
    let text = format!("counts_per_rev = 2048\nsupply_v = 12\n{more}");
    MotorFile::parse(&text, "motor.toml").expect("a sound motor file")
}

/// A text with a line a row.
fn table(head: &str, line: impl Fn(f64, f64, i64) -> String) -> String {
    let mut text = head.to_owned();
    for k in 0..ROWS {
        let (t, u, n) = row(k);
        let _ = writeln!(text, "{}", line(t, u, n));
    }
    text
}

fn comma(x: f64) -> String {
    x.to_string().replace('.', ",")
}

fn read(folder: &Path, bytes: &[u8], motor: &MotorFile) -> Recording {
    let path = folder.join("log.txt");
    fs::write(&path, bytes).expect("a file can be written");
    let all = read_recordings(&path, motor).unwrap_or_else(|error| panic!("{error}"));
    let [mut read] = <[Recording; 1]>::try_from(all.recordings).expect("one recording");
    read.source = String::new();
    // A clock may start anywhere.
    let start = read.time_s[0];
    for time in &mut read.time_s {
        *time = ((*time - start) * 1e9).round() / 1e9;
    }
    read
}

/// The motor file and the text of each way to write it.
fn ways() -> Vec<(&'static str, String, String)> {
    let ms = "[units]\ntime = \"ms\"\n[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"n\"\n";
    let numbered =
        "[units]\ntime = \"ms\"\n[columns]\ntime = \"1\"\nvoltage = \"2\"\nangle = \"3\"\n";
    let plain = |t: f64, u: f64, n: i64| format!("{t},{u},{n}");
    let mut all = vec![
        ("plain", ms, table("t,u,n\n", plain)),
        (
            "decimal commas behind semicolons",
            ms,
            table("t;u;n\n", |t, u, n| {
                format!("{};{};{n}", comma(t), comma(u))
            }),
        ),
        (
            "decimal commas behind tabs",
            ms,
            table("t\tu\tn\n", |t, u, n| {
                format!("{}\t{}\t{n}", comma(t), comma(u))
            }),
        ),
        (
            "blanks",
            ms,
            table("t   u n\n", |t, u, n| format!(" {t}  {u}   {n}")),
        ),
        (
            "rows in quotes",
            ms,
            table("\"t,u,n\"\n", |t, u, n| format!("\"{t},{u},{n}\"")),
        ),
        (
            "cells in quotes",
            ms,
            table("\"t\",\"u\",\"n\"\n", |t, u, n| {
                format!("\"{t}\",\"{u}\",\"{n}\"")
            }),
        ),
        ("no names", numbered, table("", plain)),
        (
            "boot lines",
            ms,
            table(
                "ets Jul 29 2019 12:21:46\nrst:0x1 (POWERON_RESET)\nready, go\nt,u,n\n",
                plain,
            ),
        ),
        (
            "a row of units",
            ms,
            table("t,u,n\n[ms],[V],[counts]\n", plain),
        ),
        (
            "a preamble, units and decimal commas",
            ms,
            table("Bench;3\nDate;today\nt;u;n\nms;V;1\n", |t, u, n| {
                format!("{};{};{n}", comma(t), comma(u))
            }),
        ),
        (
            "serial prints",
            ms,
            table("", |t, u, n| format!("t:{t} u:{u} n:{n}")),
        ),
        (
            "serial prints with commas",
            ms,
            table("hello\n", |t, u, n| format!("t: {t}, u = {u}, n={n}")),
        ),
        (
            "Windows' line ends",
            ms,
            table("t,u,n\r\n", |t, u, n| format!("{t},{u},{n}\r")),
        ),
        (
            "a last row cut short",
            ms,
            table("t,u,n\n", plain) + "120,1.",
        ),
    ];
    let columns = |units: &str, rest: &str| {
        format!("[units]\n{units}\n[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"n\"\n{rest}")
    };
    let mut scaled = vec![
        (
            "seconds",
            columns("time = \"s\"", ""),
            table("t,u,n\n", |t, u, n| format!("{},{u},{n}", t / 1e3)),
        ),
        (
            "microseconds",
            columns("time = \"us\"", ""),
            table("t,u,n\n", |t, u, n| format!("{},{u},{n}", t * 1e3)),
        ),
        (
            "nanoseconds",
            columns("time = \"ns\"", ""),
            table("t,u,n\n", |t, u, n| format!("{},{u},{n}", t * 1e6)),
        ),
        (
            "dates",
            columns("time = \"s\"", ""),
            table("t,u,n\n", |t, u, n| {
                format!("2026-03-01T12:00:00.{:03}Z,{u},{n}", t)
            }),
        ),
        (
            "no time",
            "[log]\nrate_hz = 500\n[columns]\nvoltage = \"u\"\nangle = \"n\"\n".to_owned(),
            table("u,n\n", |_, u, n| format!("{u},{n}")),
        ),
        (
            "percent",
            columns("time = \"ms\"\nvoltage = \"percent\"", ""),
            table("t,u,n\n", |t, u, n| format!("{t},{},{n}", u / 12.0 * 100.0)),
        ),
        (
            "eight bits",
            columns("time = \"ms\"\nvoltage = \"pwm8\"", ""),
            table("t,u,n\n", |t, u, n| format!("{t},{},{n}", u / 12.0 * 255.0)),
        ),
        (
            "a signed byte",
            columns("time = \"ms\"\nvoltage = \"int8\"", ""),
            table("t,u,n\n", |t, u, n| format!("{t},{},{n}", u / 12.0 * 127.0)),
        ),
        (
            "millivolts with the other sign",
            columns("time = \"ms\"\nvoltage = \"-mV\"", ""),
            table("t,u,n\n", |t, u, n| format!("{t},{},{n}", -1e3 * u)),
        ),
        (
            "counts with the other sign",
            columns("time = \"ms\"\nangle = \"-counts\"", ""),
            table("t,u,n\n", |t, u, n| format!("{t},{u},{}", -n)),
        ),
        (
            "duty and direction",
            columns("time = \"ms\"\nvoltage = \"pwm8\"", "direction = \"d\"\n"),
            table("t,u,d,n\n", |t, u, n| {
                format!("{t},{},{},{n}", u.abs() / 12.0 * 255.0, u8::from(u > 0.0))
            }),
        ),
        (
            "several motors",
            columns("time = \"ms\"", "[log]\nselect = \"joint=2\"\n"),
            table("t,joint,u,n\n", |t, u, n| {
                format!("{t},1,0,5\n{t},2,{u},{n}\n{t},3,9,9")
            }),
        ),
        (
            "several motors by name",
            columns("time = \"ms\"", "[log]\nselect = \"joint=elbow\"\n"),
            table("t,joint,u,n\n", |t, u, n| {
                format!("{t},wrist,0,5\n{t},elbow,{u},{n}")
            }),
        ),
    ];
    let mut ways: Vec<_> = all
        .drain(..)
        .map(|(name, motor, text)| (name, motor.to_owned(), text))
        .collect();
    ways.append(&mut scaled);
    ways
}

#[test]
fn every_way_to_write_it_gives_the_same_recording() {
    let folder = tempfile::tempdir().expect("a folder");
    let ways = ways();
    let (_, known, text) = &ways[0];
    let plain = read(folder.path(), text.as_bytes(), &motor(known));
    assert_eq!(plain.len(), ROWS);
    for (name, known, text) in &ways {
        let own = read(folder.path(), text.as_bytes(), &motor(known));
        assert_eq!(own.time_s, plain.time_s, "{name}");
        assert_eq!(own.counts, plain.counts, "{name}");
        for (own, plain) in own.command.iter().zip(&plain.command) {
            assert!((own - plain).abs() < 1e-12, "{name}: {own} for {plain}");
        }
    }
}

#[test]
fn a_preset_is_kept_with_what_is_said_beside_it() {
    for preset in PRESETS {
        let text = format!(
            "counts_per_rev = 2048.0\n[units]\ntime = \"ns\"\n[log]\npreset = \"{}\"\n",
            preset.name
        );
        let motor = MotorFile::parse(&text, "motor.toml").expect(preset.name);
        assert_eq!(motor.units.voltage, preset.command.unit, "{}", preset.name);
        assert_eq!(motor.drive_kind(), preset.drive, "{}", preset.name);
        assert_eq!(motor.to_toml(), text, "{}", preset.name);
    }
}

#[test]
fn other_encodings_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, known, text) = &ways()[0];
    let plain = read(folder.path(), text.as_bytes(), &motor(known));
    let little: Vec<u8> = std::iter::once(0xfeff)
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let big: Vec<u8> = std::iter::once(0xfeff)
        .chain(text.encode_utf16())
        .flat_map(u16::to_be_bytes)
        .collect();
    let marked = [b"\xef\xbb\xbf", text.as_bytes()].concat();
    for bytes in [little, big, marked] {
        assert_eq!(read(folder.path(), &bytes, &motor(known)), plain);
    }
}

#[test]
fn speeds_are_integrated() {
    let folder = tempfile::tempdir().expect("a folder");
    let columns = "[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"w\"\n";
    let speed = |k: usize| (k % 50) as f64 - 20.0;
    for (unit, per_count) in [
        ("counts/sample", 1.0),
        ("counts/s", 500.0),
        ("rad/s", 500.0 * std::f64::consts::TAU / 2048.0),
        ("rpm", 500.0 * 60.0 / 2048.0),
        ("-rev/s", -500.0 / 2048.0),
    ] {
        let mut text = "t,u,w\n".to_owned();
        for k in 0..ROWS {
            let _ = writeln!(text, "{},1,{}", 0.002 * k as f64, speed(k) * per_count);
        }
        let motor = motor(&format!("[units]\nangle = \"{unit}\"\n{columns}"));
        let found = read(folder.path(), text.as_bytes(), &motor);
        assert!(found.quantised, "{unit}");
        let mut angle = 0.0;
        for k in 1..ROWS {
            angle += speed(k);
            assert_eq!(found.counts[k], angle, "{unit}, row {k}");
        }
    }
}

#[test]
fn a_row_that_was_cut_off_is_left_out_with_a_note_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, known, text) = &ways()[0];
    let path = folder.path().join("cut.csv");
    fs::write(&path, format!("{text}120,1.")).expect("a file can be written");
    let all = read_recordings(&path, &motor(known)).expect("all but the last row");
    assert_eq!(all.recordings[0].len(), ROWS);
    assert!(
        all.notes[0].contains("not written to its end"),
        "{:?}",
        all.notes
    );
    let error = read_recording(&path, &motor(known))
        .expect_err("cut off")
        .to_string();
    assert!(error.contains("the row has 2 cells"), "{error}");
}

#[test]
fn a_clock_that_begins_anew_begins_a_recording() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, known, text) = &ways()[0];
    let motor = motor(known);
    let path = folder.path().join("episodes.csv");
    let (head, rows) = text.split_once('\n').expect("two lines");
    fs::write(&path, format!("{head}\n{rows}{rows}{rows}")).expect("a file can be written");
    let all = read_recordings(&path, &motor).expect("three recordings");
    let sources: Vec<&str> = all.recordings.iter().map(|r| r.source.as_str()).collect();
    assert_eq!(sources.len(), 3);
    let name = path.display().to_string();
    for (k, source) in sources.iter().enumerate() {
        assert_eq!(*source, format!("{name}#{}", k + 1));
        let part = Path::new(source);
        let one = read_recordings(part, &motor).expect("one of them");
        assert_eq!(one.recordings, all.recordings[k..=k]);
    }
    let error = read_recording(&path, &motor)
        .expect_err("three")
        .to_string();
    assert!(
        error.contains("holds 3 recordings") && error.contains("#1"),
        "{error}"
    );
    let error = read_recordings(Path::new(&format!("{name}#4")), &motor).expect_err("three");
    assert!(error.to_string().contains("has no part `4`"), "{error}");
}

#[test]
fn a_span_of_it_is_read_from_its_first_row_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let (_, known, text) = &ways()[0];
    let whole = read(folder.path(), text.as_bytes(), &motor(known));
    let part = read(
        folder.path(),
        text.as_bytes(),
        &motor(&format!("{known}[log]\nfrom_s = 0.02\nto_s = 0.06\n")),
    );
    assert_eq!(part.counts, whole.counts[10..=30]);
}

#[test]
fn beyond_the_span_nothing_but_times_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("span.csv");
    let known = "[log]\nfrom_s = 1\nto_s = 2\n";
    let rows = "0,x,x\n1,5,10\n2,6,11\n3,x,x\n4,x,x\n5,x,x\n6,x,x\n7,x,x\n8,x,x\n9,x,x\n10,x,x\n";
    fs::write(&path, format!("t_s,voltage_v,angle_counts\n{rows}{rows}"))
        .expect("a file can be written");
    let told = Cell::new(0.0);
    let all = read_recordings_with(&path, &motor(known), &|reached| {
        let part = reached.part.expect("a file has a length");
        assert!((told.get()..=1.0).contains(&part), "{part}");
        told.set(part);
    });
    let all = all.expect("two recordings").recordings;
    assert_eq!(all.len(), 2);
    for recording in all {
        assert_eq!(recording.counts, [10.0, 11.0]);
    }
    // Times are, since another recording may begin.
    fs::write(
        &path,
        "t_s,voltage_v,angle_counts\n0,5,1\n1,5,2\n2,5,3\n3,5,4\nx,5,5\n6,5,6\n",
    )
    .expect("a file can be written");
    let error = read_recordings(&path, &motor(known)).expect_err("no time");
    assert!(error.to_string().contains(":6:1"), "{error}");
}

#[test]
fn what_cannot_be_read_says_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    for (known, text, wanted) in [
        ("", "0,1,2\n1,1,3\n2,1,4\n", "--column time=1"),
        (
            "[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"n\"\n",
            "t;u;n\n0;1.234,5;1\n1;1;2\n",
            "without marks between the thousands",
        ),
        (
            "[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"n\"\n[log]\nselect = \"joint=2\"\n",
            "t,u,n\n0,1,2\n1,1,3\n",
            "no column `joint` to select rows by",
        ),
        (
            "[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"n\"\n[log]\nselect = \"j=2\"\n",
            "t,u,n,j\n0,1,2,1\n1,1,3,1\n",
            "no row has j=2",
        ),
        (
            "[units]\nvoltage = \"duty\"\n[columns]\ntime = \"t\"\nvoltage = \"u\"\nangle = \"n\"\n",
            "t,u,n\n0,50,2\n1,1,3\n",
            "--unit voltage=percent",
        ),
    ] {
        let path = folder.path().join("bad.csv");
        fs::write(&path, text).expect("a file can be written");
        let error = read_recording(&path, &motor(known))
            .expect_err(wanted)
            .to_string();
        assert!(
            error.contains(wanted) && error.contains("bad.csv"),
            "{error}"
        );
    }
    for (known, wanted) in [
        ("[units]\nangle = \"furlong\"\n", "counts/sample"),
        ("[log]\nselect = \"joint\"\n", "COLUMN=VALUE"),
        ("[log]\nfrom_s = 3\nto_s = 2\n", "holds nothing"),
        ("[log]\npreset = \"odriv\"\n", "did you mean `odrive`"),
        (
            "[drive]\nkind = \"position\"\n[units]\nangle = \"rpm\"\n",
            "a position loop acts on the angle",
        ),
    ] {
        let text = format!("counts_per_rev = 2048\n{known}");
        let error = MotorFile::parse(&text, "motor.toml")
            .expect_err(known)
            .to_string();
        assert!(error.contains(wanted), "{error}");
    }
}
