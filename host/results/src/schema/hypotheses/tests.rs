//! Every fault of a diagnosis is reported with its remedy.

use super::*;

const GOOD: &str = r#"{
  "schema": "servoid.diagnosis/1", "verdict": "missing_effects",
  "supply_v": 12.0, "no_load_rad_s": 700.0, "counts_per_rev": 2000, "sample_s": 0.001,
  "models": [
    {"effects": ["coulomb"], "role": "chosen",
     "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
     "parameters": [{"name": "coulomb.torque", "value": 0.48, "unit": "V"}]},
    {"effects": ["brush_drop"], "role": "alternative",
     "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
     "parameters": [{"name": "brush_drop.knee", "value": 0.1, "unit": "V"},
                    {"name": "brush_drop.voltage", "value": 0.5, "unit": "V"}]}
  ]
}"#;

#[test]
fn models_are_read_with_their_parameters_in_the_catalogue_s_order() {
    let (hypotheses, setup) = parse(GOOD).expect("a diagnosis");
    assert_eq!(setup.counts_per_rev, 2000.0);
    let names: Vec<String> = hypotheses.iter().map(Hypothesis::name).collect();
    assert_eq!(names, ["coulomb", "brush_drop"]);
    assert_eq!(hypotheses[0].values, [0.48]);
    // A form that is not stated is the textbook's.
    assert_eq!(hypotheses[1].values, [0.5, 0.1, 0.0]);
    assert_eq!(hypotheses[0].machine.electrical, 2.6e-4);
}

#[test]
fn every_refusal_says_what_was_seen_and_what_to_do() {
    let cases = [
        (
            "\"schema\": \"servoid.diagnosis/1\"",
            "\"schema\": \"servoid.fit/1\"",
            "servoid.fit/1",
        ),
        (
            "\"schema\": \"servoid.diagnosis/1\"",
            "\"schema\": 1",
            ":2:",
        ),
        ("\"models\"", "\"model\"", "no `models`"),
        ("\"supply_v\"", "\"supply\"", "no `supply_v`"),
        ("\"sample_s\": 0.001", "\"sample_s\": 0", "`sample_s` is 0"),
        ("700.0", "-1", "`no_load_rad_s` is -1"),
        ("[\"coulomb\"]", "[\"colomb\"]", "did you mean `coulomb`?"),
        (
            "brush_drop.knee",
            "brush_drop.nee",
            "lacks the parameter `brush_drop.knee`",
        ),
        (
            "\"value\": 0.48, \"unit\": \"V\"",
            "\"value\": 0.48, \"unit\": \"N*m\"",
            "needed is `V`",
        ),
        (
            "\"inertia_v_s2_rad\": 4.3e-4",
            "\"inertia_v_s2_rad\": 0",
            "models[0].machine.inertia_v_s2_rad",
        ),
        ("\"kb_v_s_rad\": 0.017", "\"kb\": 0.017", "kb_v_s_rad"),
        (
            "[\"brush_drop\"]",
            "[\"coulomb\"]",
            "models[1] lacks the parameter `coulomb.torque`",
        ),
        ("0.001,", "0.001", ":4:"),
    ];
    for (from, to, says) in cases {
        let broken = GOOD.replacen(from, to, 1);
        assert_ne!(broken, GOOD, "{from}");
        let message = parse(&broken).expect_err(from).to_string();
        assert!(message.contains(says), "{to}: {message}");
    }
}

#[test]
fn one_model_leaves_nothing_to_separate() {
    let start = GOOD
        .find(",\n    {\"effects\": [\"brush_drop\"]")
        .expect("it");
    let one = format!("{}]}}", &GOOD[..start]);
    let message = parse(&one).expect_err("one model").to_string();
    for word in ["only one model (coulomb)", "--between"] {
        assert!(message.contains(word), "{message}");
    }
}
