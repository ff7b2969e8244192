//! Files that are no text, or a line of which never ends.

use servoid_io::input::{MAX_LINE_BYTES, MotorFile, read_recording_from};
use std::io::{BufReader, Cursor, Read};

const HEADER: &str = "t_s,voltage_v,angle_counts\n";

fn message(bytes: &[u8]) -> String {
    let motor = MotorFile::parse("counts_per_rev = 4", "motor.toml").expect("a sound motor file");
    read_recording_from(bytes, "rec.csv", &motor)
        .expect_err("no text")
        .to_string()
}

#[test]
fn what_is_no_text_is_refused() {
    let utf16: Vec<u8> = "t_s,voltage_v\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for bytes in [
        &b"\x7fELF\x02\x01\x01\x00\x00\n"[..],
        b"\xff\xfet\x00_\x00s\x00\n",
        &utf16,
    ] {
        let message = message(bytes);
        assert!(
            message.starts_with("rec.csv:1: this is not UTF-8 text"),
            "{message}"
        );
    }
    // A degree as Windows-1252 writes it.
    let message = message(b"t_s,voltage_v,angle_counts\n0,\xb0,1\n");
    assert!(
        message.starts_with("rec.csv:2:2: column `voltage_v`: \"\u{b0}\" is not a number"),
        "{message}"
    );
}

#[test]
fn an_endless_line_is_refused_before_it_fills_memory() {
    for byte in [b'1', b',', b'"', 0] {
        let endless = std::io::repeat(byte);
        let motor = MotorFile::default();
        let error = read_recording_from(BufReader::new(endless), "rec.csv", &motor).unwrap_err();
        let message = error.to_string();
        assert!(
            message.starts_with("rec.csv:1: the line does not end within 1048576 bytes"),
            "{message}"
        );
    }
    let open_quote = Cursor::new(format!("{HEADER}0,1,\""));
    let endless = open_quote.chain(std::io::repeat(b'\n'));
    let motor = MotorFile {
        counts_per_rev: Some(4.0),
        ..MotorFile::default()
    };
    let error = read_recording_from(BufReader::new(endless), "rec.csv", &motor).unwrap_err();
    assert!(
        error.to_string().starts_with("rec.csv:2: a quote"),
        "{error}"
    );
    assert_eq!(MAX_LINE_BYTES, 1_048_576);
}
