//! `servoid diagnose`: from a recording to the name of what is missing, and on to the next recording.

use crate::contract::{Is, has, list, number};
use crate::desk::Desk;
use serde_json::Value;

/// A desk with `rec.csv` and `other.csv` of a gearmotor that hides `effect`.
fn hidden(effect: &str) -> Desk {
    let desk = Desk::new();
    for (seed, name) in [(1, "rec.csv"), (2, "other.csv")] {
        desk.done(&format!(
            "simulate --seconds 6 --hide {effect} --seed {seed} --out {name}"
        ));
    }
    desk
}

/// `servoid.diagnosis/1`.
pub fn is_diagnosis(diagnosis: &Value) {
    assert_eq!(diagnosis["schema"], "servoid.diagnosis/1");
    let errors = [
        ("effects", Is::List),
        ("rms_counts", Is::Number),
        ("validate_rms_counts", Is::Number),
    ];
    has(
        diagnosis,
        &[
            ("quantization_floor_counts", Is::Number),
            ("base", Is::Object),
            ("verdict", Is::Text),
            ("steps", Is::List),
            ("final", Is::Object),
            ("advice", Is::List),
            ("remarks", Is::List),
            ("held_out", Is::Object),
            ("models", Is::List),
            ("supply_v", Is::Number),
            ("no_load_rad_s", Is::Number),
            ("counts_per_rev", Is::Number),
            ("sample_s", Is::Number),
            ("seed", Is::Number),
            ("interrupted", Is::Flag),
        ],
    );
    let verdicts = ["complete", "missing_effects", "unexplained", "inconclusive"];
    assert!(
        verdicts.iter().any(|v| diagnosis["verdict"] == *v),
        "{diagnosis:#}"
    );
    has(&diagnosis["base"], &errors);
    has(&diagnosis["final"], &errors);
    for parameter in list(&diagnosis["final"], "parameters") {
        has(
            parameter,
            &[
                ("name", Is::Text),
                ("value", Is::Number),
                ("unit", Is::Text),
                ("std", Is::NumberOrNull),
                ("identifiable", Is::Flag),
            ],
        );
    }
    for step in list(diagnosis, "steps") {
        has(
            step,
            &[
                ("added", Is::Text),
                ("indistinguishable_from", Is::List),
                ("confidence", Is::Number),
                ("rms_counts", Is::Number),
                ("validate_rms_counts", Is::Number),
                ("foreseen_rms_counts", Is::NumberOrNull),
                ("evidence", Is::Text),
                ("candidates", Is::List),
            ],
        );
        for candidate in list(step, "candidates") {
            has(
                candidate,
                &[
                    ("effect", Is::Text),
                    ("rms_counts", Is::NumberOrNull),
                    ("validate_rms_counts", Is::NumberOrNull),
                    ("p_value", Is::NumberOrNull),
                ],
            );
        }
    }
    assert_eq!(
        diagnosis["models"][0]["effects"],
        diagnosis["final"]["effects"]
    );
}

/// The names of the steps.
fn added(diagnosis: &Value) -> Vec<&str> {
    let steps = list(diagnosis, "steps").iter();
    steps.filter_map(|step| step["added"].as_str()).collect()
}

#[test]
fn a_hidden_friction_is_named_on_the_other_recording() {
    let desk = hidden("coulomb");
    let outcome = desk.done("diagnose rec.csv --validate other.csv --json d.json");
    let diagnosis: Value = serde_json::from_str(&desk.read("d.json")).expect("JSON");
    is_diagnosis(&diagnosis);
    assert_eq!(diagnosis["verdict"], "missing_effects");
    assert_eq!(added(&diagnosis), ["coulomb"]);
    assert_eq!(diagnosis["held_out"]["kind"], "recording");
    assert!(number(&diagnosis, "base.rms_counts") > 50.0);
    assert!(number(&diagnosis, "final.validate_rms_counts") < 0.33);
    for word in [
        "missing_effects: ",
        "Coulomb friction",
        "error ladder",
        "encoder's own",
        "held out, never fitted: other.csv",
        "foreseen",
        "confidence",
        "coulomb.torque",
    ] {
        assert!(outcome.stdout.contains(word), "{word}\n{outcome}");
    }
    let wide = |line: &&str| line.chars().count() > 80;
    assert_eq!(outcome.stdout.lines().find(wide), None, "{outcome}");
}

#[test]
fn without_another_recording_the_end_is_held_out() {
    let desk = hidden("coulomb");
    let diagnosis = desk.json("diagnose rec.csv");
    is_diagnosis(&diagnosis);
    assert_eq!(added(&diagnosis), ["coulomb"]);
    assert_eq!(diagnosis["held_out"]["kind"], "end");
    assert!(number(&diagnosis, "held_out.seconds") > 0.5);
    assert!(number(&diagnosis, "final.validate_rms_counts") < 0.4);
    let text = desk.done("diagnose rec.csv").stdout;
    assert!(text.contains("held out, never fitted: its last"), "{text}");
}

#[test]
fn a_motor_without_surprises_is_complete() {
    let diagnosis = Desk::with_recording().json("diagnose rec.csv");
    is_diagnosis(&diagnosis);
    assert_eq!(diagnosis["verdict"], "complete");
    assert!(added(&diagnosis).is_empty());
}

#[test]
fn the_plan_after_a_diagnosis_separates_what_it_could_not() {
    let desk = Desk::new();
    for (seed, name) in [(1, "rec.csv"), (2, "other.csv")] {
        desk.done(&format!(
            "simulate --seconds 6 --hide offset_voltage --seed {seed} --excite steps --out {name}"
        ));
    }
    let outcome = desk.done("diagnose rec.csv --validate other.csv --json d.json");
    let diagnosis: Value = serde_json::from_str(&desk.read("d.json")).expect("JSON");
    let alike = list(&diagnosis["steps"][0], "indistinguishable_from");
    assert!(!alike.is_empty(), "{diagnosis:#}");
    let command = diagnosis["next_command"].as_str().expect("a command");
    let folded: Vec<&str> = outcome.stdout.split_whitespace().collect();
    assert!(folded.join(" ").contains(command), "{outcome}");
    let line = command.strip_prefix("servoid ").expect("its name");
    let plan = desk.json(&format!("{line} --seconds 3"));
    assert_eq!(plan["separable"], true, "{plan:#}");
    assert!(desk.path("next.csv").exists());
}
