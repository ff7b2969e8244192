//! Texts that were compressed by others' programs.

mod read;

use read::fixture;
use servoid_formats::decompressed;
use std::io::{BufRead, Read};

#[test]
fn texts_are_the_same_compressed_and_not() {
    let expected: Vec<String> = (0..300).map(|k| format!("{k},{}", 2 * k)).collect();
    for name in ["rows.csv", "rows.csv.gz", "rows.csv.zst", "members.csv.gz"] {
        let path = fixture("compressed").join(name);
        let lines: Vec<String> = decompressed(&path)
            .unwrap()
            .lines()
            .map(Result::unwrap)
            .collect();
        assert_eq!(lines, expected, "{name}");
    }
}

#[test]
fn damage_is_an_error_and_no_end_of_the_text() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["rows.csv.gz", "rows.csv.zst"] {
        let whole = std::fs::read(fixture("compressed").join(name)).unwrap();
        for length in (4..whole.len()).step_by(13) {
            let path = folder.path().join(name);
            std::fs::write(&path, &whole[..length]).unwrap();
            let mut text = Vec::new();
            let read = decompressed(&path).and_then(|mut content| content.read_to_end(&mut text));
            assert!(read.is_err(), "{name} of {length} bytes");
        }
    }
}

#[test]
fn short_and_empty_files_are_passed_through() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("short");
    for content in [&b""[..], b"1", b"\x1f", b"\x28\xb5\x2f"] {
        std::fs::write(&path, content).unwrap();
        let mut text = Vec::new();
        decompressed(&path).unwrap().read_to_end(&mut text).unwrap();
        assert_eq!(text, content);
    }
}
