//! What a file is told by, and what a reader hands on until it is told to stop.

mod expected;

use expected::folder;
use servoid_formats::{Format, FormatFault, open};
use std::ops::ControlFlow;

#[test]
fn texts_with_columns_are_none_of_the_formats() {
    for text in [
        "",
        " ",
        "t,u\n0,1\n",
        "[Header]\nt,u\n",
        "[1] 0.5 0.25\n[2] 0.5 0.5\n",
        "{t} {u}\n0 1\n",
        "[0.1 0.2]\n[0.3 0.4]\n",
        "-1,2\n",
        "NaN,1\n",
        "\"t\",\"u\"\n",
        "MATLAB wrote this",
        "PK is a name",
    ] {
        assert_eq!(Format::of(text.as_bytes()), None, "{text}");
    }
}

#[test]
fn json_is_told_by_its_first_bytes() {
    let whole = r#" {"t": [0, 1.5e-3, NaN, -Infinity], "word": "a\"b\u00e4", "on": true}"#;
    for end in 8..whole.len() {
        assert_eq!(
            Format::of(&whole.as_bytes()[..end]),
            Some(Format::Json),
            "{}",
            &whole[..end]
        );
    }
    for text in [
        "{\"t\": 1}\n{\"t\"",
        "[1, 2]\n[3, 4]\n",
        "{\"t\": NaN}\n{\"t\": 1}",
    ] {
        assert_eq!(
            Format::of(text.as_bytes()),
            Some(Format::JsonLines),
            "{text}"
        );
    }
    assert_eq!(
        Format::of(b"{\"t\": }"),
        Some(Format::Json),
        "it is told where it is wrong"
    );
}

#[test]
fn a_reader_stops_when_it_is_told_to() {
    for name in [
        "numpy/long.npy",
        "numpy/long_deflated.npz",
        "matlab/long_packed.mat",
        "hdf5/mixed_old.h5",
        "json/many.jsonl",
    ] {
        let mut log = open(&folder(name)).unwrap().unwrap();
        let long = log
            .tables()
            .iter()
            .position(|table| table.rows > Some(4096));
        let mut times = 0;
        let read = log.read(long.unwrap(), &[0], &mut |some| {
            times += 1;
            assert_eq!(some[0].len(), 4096, "{name}");
            ControlFlow::Break(())
        });
        read.unwrap();
        assert_eq!(times, 1, "{name}");
        assert!(
            log.read(99, &[0], &mut |_| ControlFlow::Continue(()))
                .is_err()
        );
    }
}

#[test]
fn lines_are_read_up_to_the_cut() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.jsonl");
    for (text, rows) in [
        ("{\"t\": 1}\n{\"t\": 2, \"u\": 3}\n{\"t\": 4, \"u\"", 2),
        ("{\"t\": 1}\n{\"t\": 2, \"u\": 3}\n{\"t\": 4", 2),
    ] {
        std::fs::write(&path, text).unwrap();
        let mut log = open(&path).unwrap().unwrap();
        assert_eq!(log.tables()[0].rows, Some(rows));
        let mut times = Vec::new();
        let read = log.read(0, &[0, 1], &mut |some| {
            assert_eq!(some[0].len(), some[1].len());
            times.extend_from_slice(&some[0]);
            ControlFlow::Continue(())
        });
        assert_eq!(times, [1.0, 2.0]);
        let error = read.unwrap_err();
        assert!(
            matches!(error.fault, FormatFault::CutShort { .. }),
            "{error}"
        );
        assert!(error.to_string().contains("line 3"), "{error}");
    }
}
