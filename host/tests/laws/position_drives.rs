//! Recordings of target angles: what is said of the loop, and what is refused.

use servoid_io::input::{MotorFile, read_recording_from};
use servoid_io::recording::{Drive, Recording};

/// A target in degrees that steps, and an angle that follows it late.
fn log() -> String {
    let mut text = "t_s,target_deg,angle_counts\n".to_owned();
    let mut angle = 0.0;
    for k in 0..400 {
        let target = if k / 50 % 2 == 0 { 90.0 } else { -90.0 };
        text += &format!("{},{target},{}\n", f64::from(k) / 1e3, f64::floor(angle));
        angle += 0.05 * (target / 360.0 * 2048.0 - angle);
    }
    text
}

fn motor(text: &str) -> Result<MotorFile, String> {
    let whole = format!("counts_per_rev = 2048\n{text}");
    MotorFile::parse(&whole, "motor.toml").map_err(|error| error.to_string())
}

fn read(text: &str) -> Result<Recording, String> {
    let motor = motor(text)?;
    let read = read_recording_from(log().as_bytes(), "rec.csv", &motor);
    read.map_err(|error| error.to_string())
}

const POSITION: &str = "supply_v = 12\n[units]\ntarget = \"deg\"\n[drive]\nkind = \"position\"\n";

#[test]
fn the_motor_gets_the_gain_times_the_error_up_to_the_limit() {
    let recording = read(&format!("{POSITION}gain_v_per_rad = 2.0\nlimit_v = 3.0\n")).unwrap();
    assert_eq!(recording.drive, Drive::Voltage);
    let drive = recording.position.as_ref().unwrap();
    assert_eq!(drive.target_counts[0], 512.0);
    let rad = std::f64::consts::TAU / 2048.0;
    for k in 5..45 {
        let middle = 0.5 * (recording.counts[k] + recording.counts[k + 1]);
        let volts = (2.0 * (512.0 - middle) * rad).min(3.0);
        assert!((recording.command[k] - volts).abs() < 0.01, "{k}");
    }
}

#[test]
fn every_fault_of_a_position_drive_says_what_to_do() {
    for (text, says) in [
        (
            "[drive]\nkind = \"position\"\n[units]\ntarget = \"deg\"\n",
            "supply_v",
        ),
        (POSITION, "gain_v_per_rad"),
        (
            "[drive]\nkind = \"position\"\ngain_v_per_rad = -1\n",
            "greater than zero",
        ),
        ("[drive]\nkind = \"position\"\ngain = 1\n", "gain_v_per_rad"),
        ("[drive]\nlimit_v = 3\n", "kind = \"position\""),
        ("gain_v_per_rad = 3\n", "under [drive]"),
        ("[units]\ntarget = \"deg\"\n", "kind = \"position\""),
        (
            "[columns]\nvoltage = \"goal\"\n[drive]\nkind = \"position\"\n",
            "`target`",
        ),
        ("[drive]\nkind = \"speed\"\n", "position"),
        (
            "supply_v = 12\n[drive]\nkind = \"position\"\ngain_v_per_rad = 2\n",
            "target = \"target_deg\"",
        ),
    ] {
        let message = read(text).expect_err(text);
        assert!(message.contains(says), "{text}\n{message}");
    }
}
