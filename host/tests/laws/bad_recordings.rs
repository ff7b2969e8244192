//! Recordings that must be refused, and the words that must tell the user where and what to do.

use servoid_io::input::{MotorFile, read_recording, read_recording_from};

const HEADER: &str = "t_s,voltage_v,angle_counts\n";

/// The message for `text` read with the motor file `motor`.
fn message(text: &[u8], motor: &str) -> String {
    let motor = MotorFile::parse(motor, "motor.toml").expect("the table's motor files are sound");
    match read_recording_from(text, "rec.csv", &motor) {
        Ok(recording) => panic!("accepted: {recording:?}"),
        Err(error) => error.to_string(),
    }
}

/// Recordings in the contract's columns: rows after the header, what the message must begin with, and what
/// else it must say.
const BAD_ROWS: &[(&str, &str, &str)] = &[
    (
        "0,1,0\n0.1,x,1\n",
        "rec.csv:3:2: column `voltage_v`: \"x\" is not a number",
        "plain number",
    ),
    (
        "0,1,0\n0.1,1V,1\n",
        "rec.csv:3:2: column `voltage_v`: \"1V\" is not a number",
        "without a unit",
    ),
    (
        "0,1,\n0.1,1,\n",
        "rec.csv: no row has an angle",
        "--column angle=NAME",
    ),
    (
        "0,1,0\n  , 1 ,1\n",
        "rec.csv: the recording has one sample",
        "at least two",
    ),
    (
        "0,1,0\n0.1,1,NaN\n",
        "rec.csv: the recording has one sample",
        "at least two",
    ),
    (
        "0,nan,0\n0.1,n/a,1\n",
        "rec.csv: the recording has no sample",
        "at least two",
    ),
    (
        "0,inf,0\n",
        "rec.csv:2:2: column `voltage_v`: \"inf\" is infinite",
        "correct",
    ),
    (
        "0,-Infinity,0\n",
        "rec.csv:2:2: column `voltage_v`: \"-Infinity\" is infinite",
        "correct",
    ),
    (
        "1e999,1,0\n",
        "rec.csv:2:1: column `t_s`: \"1e999\" is infinite or too large",
        "correct",
    ),
    (
        "0,1,0\n0.2,1,1\n0.1,1,2\n",
        "rec.csv:4:1: column `t_s`: time goes back from 0.2 s to 0.1 s",
        "sort the rows",
    ),
    (
        "0,1,0\n0.1,1,1\n0.1,1,2\n",
        "rec.csv:4: time repeats 0.1 s",
        "remove the repeated row",
    ),
    (
        "0,1,0\n0.1,1\n",
        "rec.csv:3: the row has 2 cells, the header 3",
        "separators",
    ),
    (
        "0,1,0\n0.1,1,2,3\n",
        "rec.csv:3: the row has 4 cells, the header 3",
        "separators",
    ),
    (
        "0,1,0\n0.1,1,\"2\n",
        "rec.csv:3: a quote (\") is opened",
        "remove it",
    ),
    ("", "rec.csv: the recording has no sample", "at least two"),
    (
        "0,1,0\n",
        "rec.csv: the recording has one sample",
        "at least two",
    ),
    (
        "0,1,2147483648\n",
        "rec.csv:2:3: column `angle_counts`: 2147483648 counts are beyond a 32-bit counter",
        "subtract",
    ),
    (
        "0,1,-2147483649\n",
        "rec.csv:2:3: column `angle_counts`: -2147483649 counts are beyond",
        "subtract",
    ),
    (
        "0,1,1e300\n",
        "rec.csv:2:3: column `angle_counts`: 1e300 counts are beyond",
        "subtract",
    ),
    (
        "0,1,0.5\n",
        "rec.csv:2:3: column `angle_counts`: 0.5 is not a whole number of counts",
        "[units] in motor.toml",
    ),
    // Comments and blank lines count as lines, wherever they stand.
    (
        "# one\n\n0,1,0\n# two\n\n0.1,x,1\n",
        "rec.csv:7:2: column `voltage_v`: \"x\"",
        "number",
    ),
    (
        "0,1,0\r\n# two\r\n\r\n0.1,x,1\r\n",
        "rec.csv:5:2: column `voltage_v`: \"x\"",
        "number",
    ),
    (
        "0,1,0\r0.1,1,1\r",
        "rec.csv:2: a carriage return inside the line",
        "LF or CRLF",
    ),
    (
        "0,1,\x1b[31m\n",
        "rec.csv:2:3: column `angle_counts`: \"\\u{1b}[31m\" is not a number",
        "number",
    ),
];

#[test]
fn every_bad_row_is_named_with_line_cell_and_column() {
    for (rows, begins, says) in BAD_ROWS {
        let text = format!("{HEADER}{rows}");
        let message = message(text.as_bytes(), "counts_per_rev = 2048");
        assert!(
            message.starts_with(begins),
            "{rows:?}\n  gave   {message}\n  wanted {begins}"
        );
        assert!(
            message.contains(says),
            "{rows:?}\n  gave   {message}\n  without {says}"
        );
    }
}

/// Whole files: text, motor file, what the message must begin with, what else it must say.
const BAD_FILES: &[(&str, &str, &str, &[&str])] = &[
    ("", "", "rec.csv: is empty", &["header row"]),
    (
        "# only\n# comments\n\n",
        "",
        "rec.csv: is empty",
        &["at least two samples"],
    ),
    ("\u{feff}", "", "rec.csv: is empty", &[]),
    (
        "0,1,0\n0.1,1,1\n",
        "counts_per_rev = 4",
        "rec.csv:1: the first row holds numbers (0, 1, 0)",
        &["t_s,voltage_v"],
    ),
    (
        "t,u,theta\n0,1,0\n",
        "counts_per_rev = 4",
        "rec.csv:1: no columns `t_s`, `voltage_v`, `angle_counts`; the header has `t`, `u`, `theta`",
        &[
            "Say in motor.toml",
            "[columns]\n    time = \"t\"\n    voltage = \"u\"\n    angle = \"theta\"",
        ],
    ),
    (
        "# comment\nt_s,voltage_V,angle_rad\n0,1,0\n",
        "counts_per_rev = 4",
        "rec.csv:2: no column `angle_counts`; the header has `t_s`, `voltage_V`, `angle_rad`",
        &["angle = \"angle_rad\""],
    ),
    (
        "t_s,voltage_v,qn\n0,1,0\n",
        "counts_per_rev = 4\n[columns]\nangle = \"qm\"",
        "rec.csv:1: no column `qm`; the header has `t_s`, `voltage_v`, `qn` ([columns] in motor.toml asks for it)",
        &["angle = \"qn\""],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n",
        "counts_per_rev = 4\n[columns]\ncurrent = \"amps\"",
        "rec.csv:1: no column `amps`",
        &["current = \"...\""],
    ),
    (
        "t_s,current_A,angle_counts\n0,1,0\n",
        "counts_per_rev = 4\n[drive]\nkind = \"current\"",
        "rec.csv:1: no column `voltage_v`",
        &["voltage = \"...\""],
    ),
    (
        "t_s,voltage_v,angle_counts,t_s\n",
        "counts_per_rev = 4",
        "rec.csv:1:1: column `t_s`: the header has this name 2 times",
        &["rename"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n",
        "",
        "rec.csv: counts_per_rev is not known",
        &["motor.toml", "--counts-per-rev"],
    ),
    (
        "t_s,duty,angle_counts\n0,1,0\n",
        "counts_per_rev = 4\n[units]\nvoltage = \"duty\"",
        "rec.csv: the command is a duty",
        &["supply_v = 24.0", "--supply-v"],
    ),
    (
        "t_s,voltage_v,position_m\n0,1,0\n",
        "counts_per_rev = 4\n[units]\nangle = \"m\"",
        "rec.csv: the angle is in metres",
        &["metres_per_rev"],
    ),
    (
        "t_s,voltage_v,angle_counts,enabled\n0,1,0,2\n",
        "counts_per_rev = 4",
        "rec.csv:2:4: column `enabled`: \"2\" is neither 0 nor 1",
        &["while the bridge drives"],
    ),
    (
        "t_s,voltage_v,angle_rad\n0,1,1e300\n",
        "counts_per_rev = 4\n[units]\nangle = \"rad\"",
        "rec.csv:2:3: column `angle_rad`: 6.36",
        &["beyond a 32-bit counter"],
    ),
    (
        "t_s,duty,angle_counts\n0,1e308,0\n",
        "counts_per_rev = 4\nsupply_v = 24\n[units]\nvoltage = \"duty\"",
        "rec.csv:2:2: column `duty`: a duty of 1e308 is more than all of the supply",
        &["--unit voltage=percent"],
    ),
];

#[test]
fn every_bad_file_is_named_with_the_remedy() {
    for (text, motor, begins, says) in BAD_FILES {
        let message = message(text.as_bytes(), motor);
        assert!(
            message.starts_with(begins),
            "{text:?}\n  gave   {message}\n  wanted {begins}"
        );
        for says in *says {
            assert!(
                message.contains(says),
                "{text:?}\n  gave   {message}\n  without {says}"
            );
        }
    }
}

#[test]
fn a_current_drive_is_told_to_map_its_current() {
    let message = message(b"t_s,torque,angle_counts\n", "[drive]\nkind = \"current\"");
    assert!(message.contains("voltage = \"torque\""), "{message}");
}

#[test]
fn a_folder_and_a_missing_file_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let motor = MotorFile::default();
    let message = read_recording(folder.path(), &motor)
        .unwrap_err()
        .to_string();
    assert!(
        message.ends_with("is a folder; name the CSV file inside it"),
        "{message}"
    );
    let message = read_recording(&folder.path().join("none.csv"), &motor)
        .unwrap_err()
        .to_string();
    assert!(message.contains("none.csv: cannot be read"), "{message}");
}

#[test]
fn a_flag_that_has_no_meaning_is_refused() {
    for value in [0.0, -4.0, f64::NAN, f64::INFINITY] {
        let motor = MotorFile {
            counts_per_rev: Some(value),
            ..MotorFile::default()
        };
        let text = format!("{HEADER}0,1,0\n1,1,1\n");
        let message = read_recording_from(text.as_bytes(), "rec.csv", &motor)
            .unwrap_err()
            .to_string();
        assert!(
            message.contains("a finite number greater than zero is needed"),
            "{message}"
        );
    }
}
