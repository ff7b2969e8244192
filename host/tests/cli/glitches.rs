//! Faults of a log that look like physics: each is reported by name and place, before any effect is blamed.

use crate::desk::Desk;
use crate::diagnose_pairs::{number, rewritten};
use serde_json::Value;

/// A desk with two recordings of one motor with Coulomb friction.
fn pair() -> Desk {
    Desk::with_pair("--seconds 6 --hide coulomb")
}

#[test]
fn a_reading_that_stands_alone_is_refused_with_its_sample() {
    let desk = pair();
    for off in [65536.0, -65536.0, 5000.0] {
        for row in [1, 2500, 5998] {
            rewritten(&desk, "rec.csv", "spike.csv", |k, cells| {
                if k == row {
                    cells[2] = format!("{}", number(&cells[2]) + off);
                }
            });
            let (sample, time) = (
                format!("(sample {})", row + 1),
                format!("t = {} s", row as f64 / 1e3),
            );
            for line in [
                "diagnose spike.csv --validate other.csv",
                "diagnose other.csv --validate spike.csv",
                "fit spike.csv",
            ] {
                desk.refused(line, 1, &["spike.csv", &sample, &time, "glitch"]);
            }
        }
    }
}

#[test]
fn a_log_in_milliseconds_is_told_and_read_in_its_unit() {
    let desk = pair();
    for name in ["rec.csv", "other.csv"] {
        rewritten(&desk, name, &format!("ms-{name}"), |_, cells| {
            cells[0] = format!("{:.0}", number(&cells[0]) * 1e3);
        });
    }
    let line = "diagnose ms-rec.csv --validate ms-other.csv";
    desk.refused(line, 1, &["milliseconds", "--unit time=ms", "[units]"]);
    let in_ms = desk.json(&format!("{line} --unit time=ms"));
    let plain = desk.json("diagnose rec.csv --validate other.csv");
    assert_eq!(in_ms["verdict"], "missing_effects");
    assert_eq!(in_ms["final"]["effects"], plain["final"]["effects"]);
    let error = |diagnosis: &Value| diagnosis["final"]["rms_counts"].as_f64().expect("a number");
    // A time divided by a thousand may differ in its last digit.
    assert!((error(&in_ms) - error(&plain)).abs() < 1e-6);
}

/// What a log makes of a voltage.
type Fault = fn(f64) -> f64;

#[test]
fn a_held_out_recording_at_fault_is_named_in_the_verdict() {
    let desk = pair();
    let faults: [(&str, Fault, &str); 3] = [
        ("duty.csv", |volts| volts / 12.0, "looks like a duty"),
        (
            "percent.csv",
            |volts| volts / 0.12,
            "looks like a percentage",
        ),
        (
            "clipped.csv",
            |volts| volts.clamp(-4.0, 4.0),
            "is cut off at 4.00 V",
        ),
    ];
    for (file, fault, says) in faults {
        rewritten(&desk, "other.csv", file, |_, cells| {
            cells[1] = format!("{}", fault(number(&cells[1])));
        });
        let diagnosis = desk.json(&format!("diagnose rec.csv --validate {file}"));
        assert_eq!(diagnosis["verdict"], "unexplained", "{file}");
        for key in ["summary", "cause"] {
            let text = diagnosis[key].as_str().unwrap_or_default();
            assert!(text.contains(says), "{file}: {key}: {text}");
            assert!(!text.contains("no effect of the catalogue"), "{text}");
        }
    }
}

/// The reading of `rec.csv` falls behind the shaft once, or runs ahead of it.
#[test]
fn one_event_of_lost_counts_is_named_and_one_of_gained_counts_is_not() {
    let desk = Desk::with_pair("--seconds 6");
    let text = desk.read("rec.csv");
    let readings: Vec<f64> = (text.lines().skip(1))
        .filter_map(|line| line.split(',').nth(2)?.parse().ok())
        .collect();
    let moving = |row: usize| readings[row] - readings[row - 1];
    let rows: Vec<usize> = [700, 2100, 4300]
        .into_iter()
        .map(|from| {
            (from..)
                .find(|&row| moving(row).abs() > 3.0)
                .expect("motion")
        })
        .collect();
    let events = rows.into_iter().zip([3.0, 8.0, 40.0]);
    for (row, lost) in events.take(testing::length::cases(3, 1)) {
        for (lost, named) in [(lost, true), (-lost, false)] {
            let off = lost * moving(row).signum();
            rewritten(&desk, "rec.csv", "event.csv", |k, cells| {
                if k >= row {
                    cells[2] = format!("{}", number(&cells[2]) - off);
                }
            });
            let diagnosis = desk.json("diagnose event.csv --validate other.csv");
            let steps = diagnosis["steps"].as_array().expect("a list");
            let what = format!("{lost} counts lost at row {row}: {}", diagnosis["summary"]);
            let lossy = |step: &Value| step["added"] == "missed_counts";
            assert_eq!(steps.iter().any(lossy), named, "{what}");
            let errors = &diagnosis["final"];
            let left = errors["validate_rms_counts"].as_f64().expect("a number");
            assert!(!named || (steps.len() == 1 && left < 0.33), "{what}");
        }
    }
}

#[test]
fn confidence_falls_with_what_stays_unexplained() {
    let desk = pair();
    let mut before = f64::INFINITY;
    for lost in [0.0, 12.0, 60.0] {
        rewritten(&desk, "other.csv", "jumps.csv", |row, cells| {
            let lost = if row > 4000 { lost } else { 0.0 };
            cells[2] = format!("{}", number(&cells[2]) - lost);
        });
        let diagnosis = desk.json("diagnose rec.csv --validate jumps.csv");
        let steps = diagnosis["steps"].as_array().expect("a list");
        let first = steps.first().unwrap_or(&Value::Null);
        assert_eq!(first["added"], "coulomb", "{lost} counts lost");
        let confidence = first["confidence"].as_f64().expect("a number");
        assert!(
            confidence < before,
            "{confidence} after {before}, {lost} counts lost"
        );
        before = confidence;
    }
    assert!(before < 0.7, "{before}");
}

#[test]
fn a_diagnosis_that_runs_out_of_work_says_so_and_is_the_same_again() {
    let desk = pair();
    let mut errors = Vec::new();
    for budget in [1, 4, 16, 1_000_000] {
        let line = format!("diagnose rec.csv --validate other.csv --budget {budget}");
        let diagnosis = desk.json(&line);
        assert_eq!(desk.json(&line), diagnosis, "{budget}");
        let ran_out = diagnosis["ran_out"].as_bool().expect("a flag");
        let error = diagnosis["final"]["rms_counts"].as_f64().expect("a number");
        let base = diagnosis["base"]["rms_counts"].as_f64().expect("a number");
        assert!(error <= base, "{budget}: {error} > {base}");
        let text = desk.done(&line).stdout;
        assert_eq!(text.contains("--budget"), ran_out, "{budget}: {text}");
        errors.push((ran_out, error));
    }
    assert!(errors[0].0, "a million steps are enough");
    let (ran_out, error) = errors[errors.len() - 1];
    assert!(!ran_out && error < 0.33, "{error}");
}
