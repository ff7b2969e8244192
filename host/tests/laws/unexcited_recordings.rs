//! Recordings that can be read and hold nothing to fit.

use servoid_io::input::{MotorFile, read_recording_from};

const HEADER: &str = "t_s,voltage_v,angle_counts\n";

/// Rows that are sound but hold nothing to fit.
const UNEXCITED: &[(&str, &str)] = &[
    (
        "0,0,0\n1,0,50\n2,0,90\n",
        "the command is zero in every row",
    ),
    (
        "0,1,7\n1,1,7\n2,1,7\n",
        "the encoder reads 7 counts in every row: it never moved",
    ),
    (
        "0,1,0\n1,1,4\n2,1,9\n",
        "the encoder moved only 9 counts; at least 10 are needed",
    ),
    (
        "0,1,65000\n1,1,65500\n2,1,300\n",
        "at t = 2 s, as a 16-bit counter does",
    ),
    (
        "0,1,-32000\n1,1,32700\n2,1,300\n",
        "at t = 1 s, as a 16-bit counter does",
    ),
    (
        "0,1,2147483000\n1,1,-2147483000\n",
        "at t = 1 s, as a 32-bit counter does",
    ),
];

#[test]
fn a_recording_without_a_response_says_what_is_missing() {
    let motor = MotorFile {
        counts_per_rev: Some(2048.0),
        ..MotorFile::default()
    };
    for (rows, says) in UNEXCITED {
        let text = format!("{HEADER}{rows}");
        let recording = read_recording_from(text.as_bytes(), "rec.csv", &motor).unwrap();
        let message = recording.check_excited().unwrap_err().to_string();
        assert!(
            message.starts_with("rec.csv: ") && message.contains(says),
            "{message}"
        );
    }
    let coasting = "t_s,voltage_v,angle_counts,enabled\n0,5,0,0\n1,5,50,0\n2,0,90,1\n";
    let recording = read_recording_from(coasting.as_bytes(), "rec.csv", &motor).unwrap();
    assert!(
        recording
            .check_excited()
            .unwrap_err()
            .to_string()
            .contains("while the bridge is driven")
    );
    let fine = format!("{HEADER}0,1,0\n1,1,40000\n2,1,80000\n");
    let recording = read_recording_from(fine.as_bytes(), "rec.csv", &motor).unwrap();
    assert!(recording.check_excited().is_ok());
}
