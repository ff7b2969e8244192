//! Recordings of others through the program itself: none that carries a motor in motion is refused, and no diagnosis predicts
//! worse than the afternoon's least squares (`host/benches/afternoon`).

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};
use testing::recordings::{self, Vendored};

/// Runs `servoid` on recordings of one source.
fn servoid(verb: &str, fitted: &Path, held_out: Option<&Path>, map: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_servoid"));
    command.args([verb, "--quiet", "--json", "-"]).arg(fitted);
    command.arg("--motor").arg(recordings::map(map));
    if let Some(path) = held_out {
        command.arg("--validate").arg(path);
    }
    command.output().expect("servoid starts")
}

fn said(output: &Output) -> Value {
    let text = String::from_utf8_lossy(&output.stdout);
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    serde_json::from_str(&text).unwrap_or_else(|fault| panic!("{fault}: {text}"))
}

#[test]
fn no_servo_that_holds_a_weight_is_refused_or_told_that_its_sign_is_reversed() {
    let vendored = Vendored::new();
    for motion in ["sin_time_square", "up_and_down"] {
        for gain in [100, 200, 400, 800] {
            let file = vendored.unpack(&format!("bam_xl330/{motion}_kp{gain}.csv"));
            for verb in ["check", "fit"] {
                said(&servoid(verb, &file, None, "bam_xl330.toml"));
            }
        }
    }
    let [first, other] = ["sin_time_square_kp400", "up_and_down_kp400"]
        .map(|name| vendored.unpack(&format!("bam_xl330/{name}.csv")));
    for (fitted, held_out) in [(&first, &other), (&other, &first)] {
        said(&servoid(
            "diagnose",
            fitted,
            Some(held_out),
            "bam_xl330.toml",
        ));
    }
}

/// The two runs of each pair are of one command, so that the floor is measured. Of a chirp and a sine the model explains what the motor
/// repeats; a ramp and a step turn one way only, and cannot tell.
fn knows_what_the_motor_repeats(fitted: &str, found: &Value) {
    let ratio = found["lack_of_fit"]["ratio"].as_f64().expect("repeats");
    assert_eq!(found["floor"]["kind"], "repeatability", "{fitted}");
    assert_eq!(found["floor"]["from"], "repeats", "{fitted}");
    println!("{fitted}: {ratio:.3} of what the motor repeats");
    if ["chirp_1", "sine_1"].contains(&fitted) {
        assert_eq!(found["verdict"], "missing_effects", "{fitted}");
        assert!((0.98..1.1).contains(&ratio), "{fitted}: {ratio}");
    } else {
        assert!((0.98..1.25).contains(&ratio), "{fitted}: {ratio}");
    }
}

/// The driver of this kit wakes after its log begins: 3 V are logged from the first sample on, and the first count comes 45, 135, 127 and
/// 119 ms later; at the other edges it comes after 4 ms.
#[test]
fn a_driver_that_wakes_late_is_told_and_repeats_are_found() {
    let file = |name: &str| recordings::elsewhere(&format!("fra233_g04/{name}.csv"));
    let stairs = ["stair_1", "stair_2", "stair_3", "stair_4"].map(file);
    let [Some(first), Some(second), Some(third), Some(fourth)] = stairs else {
        return;
    };
    let checked = Command::new(env!("CARGO_BIN_EXE_servoid"))
        .args(["check", "--quiet", "--json", "-"])
        .args([&first, &second, &third, &fourth])
        .arg("--motor")
        .arg(recordings::map("fra233_g04.toml"))
        .output();
    let found = said(&checked.expect("servoid starts"));
    let repeats = &found["repeats"][0];
    assert_eq!(repeats["recordings"].as_array().map(Vec::len), Some(4));
    let parting = repeats["in_windows_counts"].as_f64().expect("a number");
    assert!((70.0..150.0).contains(&parting), "{parting}");
    for (checked, first_count_ms) in (found["recordings"].as_array().expect("recordings").iter())
        .zip([45.0, 135.0, 126.5, 118.5])
    {
        let findings = checked["findings"].as_array().expect("findings");
        let late = findings
            .iter()
            .find(|finding| finding["code"] == "late_driver");
        let seen = late.expect("a late driver")["seen"]
            .as_str()
            .expect("words");
        let wakes_ms = seen.split(' ').find_map(|word| word.parse::<f64>().ok());
        let before = first_count_ms - wakes_ms.expect("a time");
        assert!((0.0..8.0).contains(&before), "{seen}");
    }
}

/// Held-out errors of the afternoon model, counts RMS, in windows of half a second and over the whole run: what
/// `host/benches/afternoon/afternoon.py` prints.
const AFTERNOON: [(&str, &str, f64, f64); 4] = [
    ("chirp_1", "chirp_2", 441.3, 967.4),
    ("sine_1", "sine_2", 646.0, 692.4),
    ("ramp_1", "ramp_2", 339.4, 429.3),
    ("step_1", "step_2", 183.9, 180.9),
];

#[test]
fn a_diagnosis_predicts_no_worse_than_an_afternoons_least_squares() {
    for (fitted, held_out, windowed, whole) in AFTERNOON {
        let file = |name: &str| recordings::elsewhere(&format!("fra233_g04/{name}.csv"));
        let (Some(first), Some(other)) = (file(fitted), file(held_out)) else {
            return;
        };
        let found = said(&servoid(
            "diagnose",
            &first,
            Some(&other),
            "fra233_g04.toml",
        ));
        let of = |key: &str| found["prediction"][key].as_f64().expect("a number");
        let (ours, ours_whole) = (
            of("validate_windowed_rms_counts"),
            of("validate_whole_rms_counts"),
        );
        println!(
            "{fitted} > {held_out}: {ours:.1} against {windowed}, {ours_whole:.1} against {whole}"
        );
        knows_what_the_motor_repeats(fitted, &found);
        assert!(
            (0.5 * windowed..1.12 * windowed).contains(&ours),
            "{fitted}: {ours}"
        );
        assert!(
            (0.5 * whole..1.12 * whole).contains(&ours_whole),
            "{fitted}: {ours_whole}"
        );
    }
}
