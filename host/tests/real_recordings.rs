//! Recordings measured by others, through the motor files in `tests/maps`. They are not part of the project:
//! where they are missing the tests say so and pass.

use std::path::Path;

#[path = "real/folder.rs"]
mod folder;

use folder::folder;
use host::input::{MotorFile, read_recording};
use host::recording::{Drive, Recording};

fn read(folder: &Path, file: &str, map: &str) -> Recording {
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/maps");
    let motor = MotorFile::read(&maps.join(map)).unwrap_or_else(|error| panic!("{error}"));
    let recording =
        read_recording(&folder.join(file), &motor).unwrap_or_else(|error| panic!("{error}"));
    recording
        .check_excited()
        .unwrap_or_else(|error| panic!("{error}"));
    let (least, most) = range(&recording.counts);
    eprintln!(
        "{file}: {} samples, {:.3} s, every {:.6} s, {least} ... {most} counts, quantised: {}",
        recording.len(),
        recording.duration_s(),
        recording.median_interval_s(),
        recording.quantised
    );
    recording
}

fn range(values: &[f64]) -> (f64, f64) {
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
            (least.min(*x), most.max(*x))
        })
}

#[test]
fn un_dcmotor_counts_sum_to_the_logged_differences() {
    let Some(folder) = folder() else { return };
    let recording = read(&folder, "un_dcmotor/prbs_open.csv", "un_dcmotor.toml");
    assert_eq!(recording.len(), 4093);
    assert!(recording.quantised);
    assert_eq!(recording.drive, Drive::Voltage);
    // The same log also holds the count differences as the firmware read them.
    let text = std::fs::read_to_string(folder.join("un_dcmotor/prbs_open.csv")).unwrap();
    let logged = text
        .lines()
        .skip(2)
        .map(|line| line.rsplit(',').next().unwrap().parse::<f64>().unwrap());
    for (pair, difference) in recording.counts.windows(2).zip(logged) {
        assert_eq!(pair[1] - pair[0], difference);
    }
}

#[test]
fn emps_is_a_current_driven_axis_of_whole_counts() {
    let Some(folder) = folder() else { return };
    let recording = read(&folder, "emps/emps_train.csv", "emps.toml");
    assert_eq!(recording.len(), 24841);
    assert!(recording.quantised);
    assert_eq!(recording.drive, Drive::Current);
    // 0.00000745 m at 2.5 mm and 50,000 counts a revolution.
    assert_eq!(recording.counts[0], 149.0);
}

#[test]
fn every_bam_recording_is_in_whole_counts_and_says_when_it_was_driven() {
    let Some(folder) = folder() else { return };
    for motion in ["sin_time_square", "up_and_down"] {
        for gain in [100, 200, 400, 800] {
            let recording = read(
                &folder,
                &format!("bam_xl330/{motion}_kp{gain}.csv"),
                "bam_xl330.toml",
            );
            assert!(recording.quantised);
            assert_eq!(
                recording.enabled.as_ref().map(Vec::len),
                Some(recording.len())
            );
        }
    }
}

#[test]
fn odrive_is_current_driven_and_its_observer_is_no_counter() {
    let Some(folder) = folder() else { return };
    let recording = read(
        &folder,
        "odrive_cogging/slow2_nocomp_0.csv",
        "odrive_cogging.toml",
    );
    assert_eq!(recording.len(), 4306);
    assert_eq!(recording.drive, Drive::Current);
    assert_eq!(recording.command[0], 0.64064);
}
