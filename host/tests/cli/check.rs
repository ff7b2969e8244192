//! `servoid check`: each fault of a recording gives its own finding, and none that is not there.

use crate::desk::Desk;
use crate::diagnose_pairs::{number, rewritten};
use serde_json::Value;

/// The codes that a check of `file` finds, remarks that say nothing of a fault left out.
fn codes(desk: &Desk, file: &str) -> Vec<String> {
    let outcome = desk.run(&format!("check {file} --json -"));
    let json: Value =
        serde_json::from_str(&outcome.stdout).unwrap_or_else(|error| panic!("{error}\n{outcome}"));
    assert_eq!(json["schema"], "servoid.check/1");
    let findings = json["recordings"][0]["findings"]
        .as_array()
        .expect("a list");
    let refused = findings.iter().any(|f| f["severity"] == "refusal");
    assert_eq!(outcome.code, Some(i32::from(refused)), "{outcome}");
    for finding in findings {
        for key in ["seen", "remedy"] {
            assert!(
                !finding[key].as_str().expect("a text").is_empty(),
                "{finding}"
            );
        }
    }
    let code = |finding: &Value| finding["code"].as_str().expect("a code").to_owned();
    findings.iter().map(code).collect()
}

type Change = fn(usize, &mut Vec<String>);

fn scaled(cell: &mut String, factor: f64) {
    *cell = format!("{}", number(cell) * factor);
}

#[test]
fn each_fault_gives_its_own_finding_and_no_other() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --out rec.csv");
    let faults: [(&str, &[&str], Change); 6] = [
        ("sound", &[], |_, _| {}),
        ("reversed", &["reversed"], |_, cells| {
            scaled(&mut cells[2], -1.0);
        }),
        ("millivolts", &["command_unit"], |_, cells| {
            scaled(&mut cells[1], 1000.0);
        }),
        ("percent", &["command_unit"], |_, cells| {
            // The largest command of the bench is its supply.
            scaled(&mut cells[1], 100.0 / 12.0);
        }),
        ("gap", &["gaps"], |row, cells| {
            if row >= 2000 {
                cells[0] = format!("{}", number(&cells[0]) + 0.1);
            }
        }),
        ("unrelated", &["no_response"], |row, cells| {
            cells[1] = format!("{}", if (row * 7919) % 211 > 105 { 6.0 } else { -6.0 });
        }),
    ];
    for (name, expected, change) in faults {
        let file = format!("{name}.csv");
        rewritten(&desk, "rec.csv", &file, change);
        assert_eq!(codes(&desk, &file), expected, "{name}");
    }
}

#[test]
fn held_readings_are_found_with_their_interval() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --out rec.csv");
    let mut held = String::new();
    let held = std::cell::RefCell::new(&mut held);
    rewritten(&desk, "rec.csv", "held.csv", |row, cells| {
        let mut held = held.borrow_mut();
        if row % 4 == 0 {
            held.clone_from(&cells[2]);
        }
        cells[2].clone_from(&held);
    });
    let text = desk.done("check held.csv").stdout;
    assert!(text.contains("every 0.0040 s"), "{text}");
}

#[test]
fn a_refusal_is_overridden_by_force() {
    let desk = Desk::new();
    desk.done("simulate --seconds 3 --out rec.csv");
    rewritten(&desk, "rec.csv", "mv.csv", |_, cells| {
        scaled(&mut cells[1], 1000.0);
    });
    for verb in ["fit", "diagnose"] {
        desk.refused(&format!("{verb} mv.csv"), 1, &["another unit", "supply_v"]);
        desk.done(&format!("{verb} mv.csv --force"));
    }
}
