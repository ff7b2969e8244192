//! `simulate --plan`: what to record next, from typical effects or after a diagnosis.

use crate::contract::{has, list, number};
use crate::desk::Desk;
use crate::width::unfolded;

/// A plan that takes no time.
const QUICK: &str = "simulate --plan --between coulomb,dead_zone --seconds 1 --out plan.csv";

/// What `diagnose --json` writes, as far as a plan reads it.
const DIAGNOSIS: &str = r#"{
  "schema": "servoid.diagnosis/1", "verdict": "missing_effects",
  "supply_v": 12.0, "no_load_rad_s": 700.0, "counts_per_rev": 2000, "sample_s": 0.001,
  "models": [
    {"effects": ["load_torque"], "role": "chosen",
     "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
     "parameters": [{"name": "load_torque.torque", "value": 0.3, "unit": "V", "std": 0.01}]},
    {"effects": ["offset_voltage"], "role": "alternative",
     "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
     "parameters": [{"name": "offset_voltage.voltage", "value": -0.3, "unit": "V", "std": null}]}
  ]
}"#;

#[test]
fn a_plan_has_the_keys_of_its_schema_and_the_commands_that_it_tells_of() {
    let desk = Desk::new();
    let plan = desk.json(&format!(
        "{QUICK} --max-voltage 6 --max-current 3 --resistance 2.3 --travel 20"
    ));
    assert_eq!(plan["schema"], "servoid.plan/1");
    assert_eq!(plan["separable"], true);
    assert_eq!(plan["plan"], "plan.csv");
    let keys = "separation_counts: number, threshold_counts: number, hypotheses: list, \
        candidates: list, samples: number, sample_s: number, reason: text, advice: list, \
        seed: number, version: text";
    has(&plan, keys);
    let candidates = list(&plan, "candidates");
    assert_eq!(candidates.len(), 3);
    let mut last = f64::INFINITY;
    for candidate in candidates {
        let least = number(candidate, "separation_counts");
        assert!(least <= last, "best first: {plan:#}");
        last = least;
        assert_eq!(list(candidate, "pairs").len(), 2);
        assert!(number(candidate, "peak_voltage_v") <= 6.0);
        assert!(number(candidate, "peak_current_a") <= 3.0);
        assert!(number(candidate, "travel_rev") <= 20.0);
    }
    let csv = desk.read("plan.csv");
    let rows: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(
        csv.starts_with("# made by servoid") && csv.contains("seed 1"),
        "{csv}"
    );
    assert!(
        rows[0] == "t_s,voltage_v" || rows[0] == "t_s,voltage_v,enabled",
        "{}",
        rows[0]
    );
    assert_eq!(rows.len() as f64 - 1.0, number(&plan, "samples"));
    for row in &rows[1..] {
        let volts: f64 = row
            .split(',')
            .nth(1)
            .expect("a voltage")
            .parse()
            .expect("a number");
        assert!(volts.abs() <= 6.0, "{row}");
    }
}

#[test]
fn the_text_ranks_three_and_says_why() {
    let text = Desk::new().done(QUICK).stdout;
    for word in [
        "  1. ",
        "  2. ",
        "  3. ",
        "coulomb if dead_zone is true",
        "travel",
        "why: ",
        "plan.csv",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn the_same_seed_plans_the_same_bytes_on_any_number_of_cores() {
    let planned = |threads: &str| {
        let desk = Desk::new();
        let mut command = desk.command(&format!("{QUICK} --seed 5 --json plan.json"));
        let done = command.env("RAYON_NUM_THREADS", threads).output();
        assert!(done.expect("servoid starts").status.success());
        (desk.read("plan.csv"), desk.read("plan.json"))
    };
    let first = planned("1");
    assert_eq!(first, planned("1"));
    assert_eq!(first, planned("3"));
}

#[test]
fn after_a_diagnosis_its_models_are_separated() {
    let desk = Desk::new();
    desk.write("diagnosis.json", DIAGNOSIS);
    let plan = desk.json("simulate --plan --after diagnosis.json --seconds 1 --out plan.csv");
    assert_eq!(plan["separable"], true);
    assert_eq!(plan["candidates"][0]["coasts"], true, "{plan:#}");
    assert_eq!(plan["hypotheses"][1]["parameters"][0]["value"], -0.3);
    assert!(desk.read("plan.csv").contains("t_s,voltage_v,enabled"));
}

#[test]
fn what_cannot_be_separated_is_said_plainly_and_nothing_is_written() {
    let desk = Desk::new();
    // A tenth of a volt is far below the break-away of either.
    let line =
        "simulate --plan --between coulomb,dead_zone --seconds 1 --max-voltage 0.1 --out plan.csv";
    let plan = desk.json(line);
    assert_eq!(plan["separable"], false);
    assert!(plan["plan"].is_null() && plan["reason"].is_null());
    assert!(!desk.path("plan.csv").exists());
    let text = unfolded(&desk.done(line).stdout);
    for word in [
        "cannot be separated with voltage and angle within these limits",
        "current sensor",
        "wider limits",
        "nothing was written",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn wrong_use_is_refused_by_the_flag_s_name() {
    let both = "simulate --plan --out plan.csv --between coulomb,brush_drop";
    let cases: &[(&str, &[&str])] = &[
        (
            "simulate --plan --out plan.csv --between colomb,brush_drop",
            &["--between", "'coulomb'"],
        ),
        (
            "simulate --plan --out plan.csv --between coulomb",
            &["--between", "one effect", "at least two"],
        ),
        (
            "simulate --plan --out plan.csv --between coulomb,coulomb",
            &["--between", "twice"],
        ),
        ("simulate --plan --out plan.csv", &["--between", "--after"]),
        ("simulate --plan --between coulomb,brush_drop", &["--out"]),
        (
            "simulate --out plan.csv --between coulomb,brush_drop",
            &["--plan"],
        ),
        ("simulate --out plan.csv --travel 3", &["--plan"]),
    ];
    let flags: &[(&str, &[&str])] = &[
        (
            "--after diagnosis.json",
            &["--between", "--after", "cannot be used"],
        ),
        ("--seconds 0", &["--seconds 0", "positive"]),
        ("--seconds 1e-3", &["--seconds 0.001", "samples"]),
        ("--seconds inf", &["--seconds", "positive"]),
        ("--travel -2", &["--travel -2", "positive"]),
        ("--travel nan", &["--travel", "positive"]),
        ("--max-voltage 0", &["--max-voltage 0", "positive"]),
        (
            "--max-current 2",
            &["--max-current 2", "--resistance", "ohmmeter"],
        ),
        (
            "--max-current 2 --resistance 0",
            &["--resistance 0", "positive"],
        ),
        ("--sample 0", &["--sample 0", "positive"]),
        ("--counts-per-rev 0", &["--counts-per-rev 0"]),
        ("--machine gear_motor", &["--machine", "gearmotor"]),
        ("--hide coulomb", &["--hide", "--plan"]),
        ("--excite steps", &["--excite", "--plan"]),
        ("--jitter 1e-4", &["--jitter", "--plan"]),
    ];
    let desk = Desk::new();
    for (line, says) in cases {
        desk.refused(line, 2, says);
    }
    for (flag, says) in flags {
        desk.refused(&format!("{both} {flag}"), 2, says);
    }
}

#[test]
fn a_diagnosis_that_cannot_be_planned_from_is_refused_with_its_place() {
    let one_model = DIAGNOSIS
        .replace("offset_voltage", "load_torque")
        .replace("load_torque.voltage", "load_torque.torque");
    let cases: &[(&str, &[&str])] = &[
        (&DIAGNOSIS[..200], &["diagnosis.json:5:", "diagnose"]),
        ("", &["diagnosis.json:1:0", "diagnose"]),
        (
            "{\"schema\": \"servoid.fit/1\"}",
            &["servoid.fit/1", "servoid.diagnosis/1"],
        ),
        (
            "{\"schema\": \"servoid.diagnosis/1\"}",
            &["`models`", "again"],
        ),
        (&one_model, &["only one model (load_torque)", "--between"]),
    ];
    for (content, says) in cases {
        let desk = Desk::new();
        desk.write("diagnosis.json", content);
        desk.refused(
            "simulate --plan --after diagnosis.json --out plan.csv",
            1,
            says,
        );
    }
    let desk = Desk::new();
    desk.refused(
        "simulate --plan --after nowhere.json --out plan.csv",
        1,
        &["nowhere.json", "cannot be read"],
    );
    desk.write("diagnosis.json", DIAGNOSIS);
    let both = "simulate --plan --after diagnosis.json --out";
    desk.refused(
        &format!("{both} diagnosis.json"),
        2,
        &["--out", "the diagnosis"],
    );
    desk.refused(
        &format!("{both} plan.csv --machine paper"),
        2,
        &["--machine", "--after"],
    );
}

#[test]
fn limits_that_no_excitation_keeps_are_an_error_with_a_remedy() {
    // The load drives the shaft by itself, whatever is commanded.
    let line = "simulate --plan --between load_torque,offset_voltage --seconds 5 --travel 1 --out plan.csv";
    Desk::new().refused(line, 1, &["load_torque", "--travel", "--seconds"]);
}
