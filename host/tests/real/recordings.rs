//! How recordings are read through the motor files in `tests/maps`.

use crate::source::{elsewhere, vendored};
use servoid_io::recording::{Drive, Recording};
use testing::recordings::Vendored;

/// Prints what a recording has, and holds it to what can be fitted at all.
fn sound(file: &str, recording: Recording) -> Recording {
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
    let file = "un_dcmotor/prbs_open";
    let recording = sound(file, vendored(file));
    assert_eq!(recording.len(), 4093);
    assert!(recording.quantised);
    assert_eq!(recording.drive, Drive::Voltage);
    // The same log also holds the count differences as the firmware read them.
    let recordings = Vendored::new();
    let text = std::fs::read_to_string(recordings.unpack("un_dcmotor/prbs_open.csv")).unwrap();
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
    let file = "emps/emps_train";
    let Some(recording) = elsewhere(file) else {
        return;
    };
    let recording = sound(file, recording);
    assert_eq!(recording.len(), 24841);
    assert!(recording.quantised);
    assert_eq!(recording.drive, Drive::Current);
    // 0.00000745 m at 2.5 mm and 50,000 counts a revolution.
    assert_eq!(recording.counts[0], 149.0);
}

#[test]
fn every_bam_recording_is_in_whole_counts_and_says_when_it_was_driven() {
    for motion in ["sin_time_square", "up_and_down"] {
        for gain in [100, 200, 400, 800] {
            let file = format!("bam_xl330/{motion}_kp{gain}");
            let recording = sound(&file, vendored(&file));
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
    let file = "odrive_cogging/slow2_nocomp_0";
    let recording = sound(file, vendored(file));
    assert_eq!(recording.len(), 4306);
    assert_eq!(recording.drive, Drive::Current);
    assert_eq!(recording.command[0], 0.64064);
}

#[test]
fn qube_is_in_whole_counts_and_turns_both_ways() {
    for episode in ["00", "02"] {
        let file = format!("qube/qube_{episode}");
        let recording = sound(&file, vendored(&file));
        assert!(recording.quantised);
        assert_eq!(recording.drive, Drive::Voltage);
        assert!((recording.median_interval_s() - 0.002).abs() < 1e-6);
        let (least, most) = range(&recording.counts);
        assert!(least < 0.0 && most > 0.0, "{least} to {most}");
    }
}
