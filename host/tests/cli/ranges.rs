//! Search ranges: they widen by themselves, unless the user sets them.

use crate::contract::{number, parameter};
use crate::desk::Desk;
use serde_json::json;

/// Effects as strong as no usual range holds, with the parameter that lies beyond.
const BEYOND: [(&str, &str, f64); 3] = [
    ("compliance", "compliance.period", 36.0),
    ("l_sat", "l_sat.falloff", 10.0),
    ("torque_sat", "torque_sat.cubic", 6.0),
];
/// RMS error of a right model, counts: the encoder's own with some room.
const FLOOR: f64 = 0.33;

fn desk(effect: &str, strength: f64) -> Desk {
    Desk::with_pair(&format!("--hide {effect}:strength={strength}"))
}

#[test]
fn an_effect_beyond_its_usual_range_is_named_and_said_to_be() {
    for (effect, name, strength) in BEYOND {
        let desk = desk(effect, strength);
        let said = desk.done("diagnose rec.csv --validate other.csv --json d.json");
        let diagnosis = desk.read_json("d.json");
        assert_eq!(diagnosis["final"]["effects"], json!([effect]));
        for key in ["rms_counts", "validate_rms_counts"] {
            let error = number(&diagnosis["final"], key);
            assert!(error < FLOOR, "{effect}: {key} {error}");
        }
        let sentence = format!("{name} lies beyond its usual range");
        assert!(said.stdout.contains(&sentence), "{said}");
    }
}

#[test]
fn a_range_that_the_user_sets_is_kept() {
    let (effect, name, strength) = BEYOND[2];
    let desk = desk(effect, strength);
    let most = 0.002;
    let said = desk.done(&format!(
        "fit rec.csv --with {effect} --bounds {name}=0:{most} --json fit.json"
    ));
    let fit = desk.read_json("fit.json");
    assert!(number(parameter(&fit, name), "value") <= most);
    assert!(said.stdout.contains("ended on a bound"), "{said}");
    assert!(!said.stdout.contains("beyond its usual range"), "{said}");
}
