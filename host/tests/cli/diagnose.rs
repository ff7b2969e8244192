//! `servoid diagnose`: from a recording to the name of what is missing, and on to the next recording.

use crate::contract::{has, is_parameter, list, number};
use crate::desk::Desk;
use crate::width::{fits_a_terminal, unfolded};
use serde_json::Value;

/// A desk with `rec.csv` and `other.csv` of a gearmotor that hides `effect`.
fn hidden(effect: &str) -> Desk {
    Desk::with_pair(&format!("--seconds 6 --hide {effect}"))
}

/// `servoid.diagnosis/1`.
pub fn is_diagnosis(diagnosis: &Value) {
    assert_eq!(diagnosis["schema"], "servoid.diagnosis/1");
    let errors = "effects: list, rms_counts: number, validate_rms_counts: number";
    has(
        diagnosis,
        "quantization_floor_counts: number, base: object, verdict: text, steps: list, \
         final: object, advice: list, remarks: list, cannot_tell: list, residual: object, \
         held_out: object, models: list, supply_v: number, no_load_rad_s: number, \
         counts_per_rev: number, sample_s: number, seed: number, interrupted: flag",
    );
    let verdicts = ["complete", "missing_effects", "unexplained", "inconclusive"];
    assert!(
        verdicts.iter().any(|v| diagnosis["verdict"] == *v),
        "{diagnosis:#}"
    );
    has(&diagnosis["base"], errors);
    has(&diagnosis["final"], errors);
    for parameter in list(&diagnosis["final"], "parameters") {
        is_parameter(parameter);
    }
    for step in list(diagnosis, "steps") {
        has(
            step,
            "added: text, indistinguishable_from: list, confidence: number, rms_counts: number, \
             validate_rms_counts: number, foreseen_rms_counts: number?, evidence: text, \
             where: object, candidates: list",
        );
        for candidate in list(step, "candidates") {
            has(
                candidate,
                "effect: text, rms_counts: number?, validate_rms_counts: number?, p_value: number?",
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
    let diagnosis = desk.read_json("d.json");
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
    let why = "residual torque changes sign with speed and does not grow with it";
    let evidence = diagnosis["steps"][0]["evidence"].as_str().expect("text");
    assert!(evidence.starts_with(why), "{evidence}");
    let residual = &diagnosis["residual"];
    assert_eq!(residual["base_whiteness"]["white"], false);
    assert_eq!(residual["final_whiteness"]["white"], true);
    fits_a_terminal("diagnose", &outcome.stdout);
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
    let desk = Desk::with_pair("--seconds 6 --hide offset_voltage --excite steps");
    let outcome = desk.done("diagnose rec.csv --validate other.csv --json d.json");
    let diagnosis = desk.read_json("d.json");
    let alike = list(&diagnosis["steps"][0], "indistinguishable_from");
    assert!(!alike.is_empty(), "{diagnosis:#}");
    let command = diagnosis["next_command"].as_str().expect("a command");
    assert!(unfolded(&outcome.stdout).contains(command), "{outcome}");
    let line = command.strip_prefix("servoid ").expect("its name");
    let plan = desk.json(&format!("{line} --seconds 3"));
    assert_eq!(plan["separable"], true, "{plan:#}");
    assert!(desk.path("next.csv").exists());
}

#[test]
fn a_recording_that_never_reverses_is_inconclusive_and_says_what_to_record() {
    let desk = Desk::with_pair("--seconds 2 --excite step --hide coulomb:strength=2");
    let diagnosis = desk.json("diagnose rec.csv --validate other.csv");
    is_diagnosis(&diagnosis);
    if number(&diagnosis, "base.rms_counts") > 0.33 {
        assert_eq!(diagnosis["verdict"], "inconclusive", "{diagnosis:#}");
        let advice = diagnosis["advice"][0].as_str().expect("advice");
        assert!(advice.contains("never reverses"), "{advice}");
    }
}

#[test]
fn the_ladder_of_a_fit_falls_with_each_effect_in_its_order() {
    let desk = hidden("coulomb");
    let line = "fit rec.csv --validate other.csv --with coulomb,cogging";
    let fit = desk.json(line);
    let ladder = list(&fit, "ladder");
    let added: Vec<&Value> = ladder.iter().map(|rung| &rung["added"]).collect();
    assert_eq!(
        serde_json::json!(added),
        serde_json::json!([null, "coulomb", "cogging"])
    );
    assert!(number(&ladder[0], "rms_counts") > 50.0);
    assert!(number(&ladder[1], "validate_rms_counts") < 0.33);
    assert_eq!(ladder[2]["rms_counts"], fit["rms_counts"]);
    let text = desk.done(line).stdout;
    for word in ["error ladder", "linear motor", "+ coulomb", "encoder's own"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn a_curve_of_steady_speeds_shows_a_drop_that_no_one_effect_is_named_for() {
    let desk = Desk::new();
    let row = |k: i32| {
        let speed = f64::from(k);
        // Reading errors with no trend.
        let volts = 0.5 * speed + 0.2 + 1e-3 * f64::from([1, -1, -1, 1][k as usize % 4]);
        format!("{volts},{speed}\n")
    };
    let rows: String = (1..=12).map(row).collect();
    desk.write("curve.csv", format!("voltage_V,speed_rad_s\n{rows}"));
    let outcome = desk.done("diagnose curve.csv");
    assert!(
        outcome.stdout.contains("inconclusive"),
        "{}",
        outcome.stdout
    );
    let json = desk.json("diagnose curve.csv");
    assert_eq!(json["schema"], "servoid.diagnosis/1");
    assert_eq!(json["verdict"], "inconclusive");
    assert_eq!(json["steps"], serde_json::json!([]));
    let drop = json["steady"]["with_drop"]["drop_v"].as_f64();
    assert!((drop.expect("a drop") - 0.2).abs() < 2e-3, "{json:#}");
    assert!(!json["advice"].as_array().expect("a list").is_empty());
    let refusals: [(&str, &[&str]); 4] = [
        ("voltage_V,speed_rad_s\n", &["too few"]),
        (
            "voltage_V,speed_rad_s\n1,x\n",
            &["curve.csv:2", "speed_rad_s"],
        ),
        ("voltage_V,speed_rad_s\n1,NaN\n", &["finite"]),
        (
            "voltage_V,speed_rad_s\n1,-1\n2,-2\n3,-3\n4,-4\n5,-5\n",
            &["does not grow"],
        ),
    ];
    for (content, says) in refusals {
        desk.write("curve.csv", content);
        desk.refused("diagnose curve.csv", 1, says);
    }
    desk.refused(
        "diagnose curve.csv --validate curve.csv",
        2,
        &["--validate"],
    );
}

/// Ramps a little apart: each free run near standstill is chaotic, so that one ramp alone proves nothing.
const RAMPS: [f64; 6] = [0.098, 0.099, 0.1, 0.101, 0.103, 0.105];

/// A motor that turns slowly all the time hardly tells friction from a stage that swallows as many volts: the right one leaves 0.24 to 0.30 counts, the
/// other, as well as it can be fitted, 0.6 to 0.7. What is hidden must be named, alone or beside the other, and never the other alone.
#[test]
fn on_slow_ramps_friction_and_a_dead_zone_are_told_apart_or_stand_beside_each_other() {
    let ramps = testing::length::cases(RAMPS.len(), 3);
    let (mut right, mut explained, mut seen) = (0, 0, Vec::new());
    for effect in ["coulomb", "dead_zone"] {
        for ramp in &RAMPS[..ramps] {
            let desk = Desk::new();
            desk.done(&format!(
                "simulate --hide {effect} --excite triangle --amplitude {ramp} --seconds 20 --out ramp.csv"
            ));
            let diagnosis = desk.json("diagnose ramp.csv");
            explained += usize::from(diagnosis["verdict"] == "missing_effects");
            let steps = list(&diagnosis, "steps").iter();
            let set: Vec<String> = steps
                .flat_map(|step| {
                    list(step, "indistinguishable_from")
                        .iter()
                        .chain([&step["added"]])
                })
                .filter_map(|name| Some(name.as_str()?.to_owned()))
                .collect();
            right += usize::from(set.iter().any(|own| own == effect));
            seen.push(format!("{effect} at {ramp}: {set:?}"));
        }
    }
    assert!(
        right * 6 >= 5 * seen.len() && explained * 6 >= 5 * seen.len(),
        "{right} and {explained} of {}: {seen:#?}",
        seen.len()
    );
}
