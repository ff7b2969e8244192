use super::*;

const FIT: &str = r#"{
  "schema": "servoid.fit/1", "drive": "voltage", "supply_v": 12.0, "counts_per_rev": 2000, "sample_s": 0.001,
  "recording": "a.csv", "converged": true, "effects": ["coulomb"],
  "parameters": [
    {"name": "gain", "value": 58.0, "unit": "rad/(s*V)", "std": 0.001, "identifiable": true},
    {"name": "coulomb.torque", "value": 0.36, "unit": "V", "std": null, "identifiable": false}
  ],
  "model": {
    "effects": ["coulomb"],
    "machine": {"kb_v_s_rad": 0.017, "damping_v_s_rad": 1e-4, "inertia_v_s2_rad": 4.3e-4, "electrical_s": 2.6e-4},
    "parameters": [{"name": "coulomb.torque", "value": 0.36, "unit": "V"}]
  }
}"#;

fn diagnosis() -> String {
    let model = FIT.split_once("\"converged\"").expect("a key").1;
    let head = FIT.split_once("\"converged\"").expect("a key").0;
    let head = head.replace("servoid.fit/1", "servoid.diagnosis/1");
    format!("{head} \"final\": {{\"converged\"{model}}}")
}

const DEVICE: &str = r#"{
  "schema": "servoid.device/1", "period_us": 1000, "supply_v": 24.0, "counts_per_rev": 2000,
  "outcome": {"converged": true, "rms_counts": 0.3, "parameters": [
    {"name": "gain", "value": 40.0, "unit": "rad/s/V", "std": 0.01},
    {"name": "a1", "value": 0.02, "unit": "s", "std": 0.0001},
    {"name": "electrical", "value": 0.001, "unit": "s", "std": null},
    {"name": "coulomb", "value": 0.5, "unit": "V", "std": 0.01}]}
}"#;

#[test]
fn a_fit_a_diagnosis_and_a_verification_of_one_model_say_the_same() {
    let fit = Identified::parse(FIT).expect("a fit");
    let diagnosis = diagnosis();
    let verify = format!("{{\"schema\": \"servoid.verify/1\", \"diagnosis\": {diagnosis}}}");
    for text in [diagnosis.as_str(), &verify] {
        let read = Identified::parse(text).expect("a result");
        assert_eq!(
            (&read.model, &read.parameters, read.sample_s),
            (&fit.model, &fit.parameters, fit.sample_s)
        );
    }
}

#[test]
fn a_device_s_report_becomes_the_machine_that_has_its_response() {
    let read = Identified::parse(DEVICE).expect("a report");
    let machine = read.model.machine.machine("model").expect("a machine");
    let response = machine.response();
    assert!((response.gain - 40.0).abs() < 1e-9 && (response.a1 - 0.02).abs() < 1e-12);
    assert!((machine.electrical - 0.001).abs() < 1e-12);
    assert_eq!(read.model.effects, ["coulomb"]);
    assert_eq!(read.sample_s, Some(1e-3));
    let names: Vec<(&str, bool)> = (read.parameters.iter())
        .map(|p| (p.name.as_str(), p.identifiable))
        .collect();
    assert_eq!(
        names,
        [
            ("gain", true),
            ("a1", true),
            ("electrical_time_constant", false),
            ("coulomb.torque", true)
        ]
    );
}

#[test]
fn a_device_s_viscous_part_is_the_machine_s_and_its_failure_is_told() {
    let text = DEVICE.replace(
        "\"std\": 0.01}]}",
        "\"std\": 0.01}, {\"name\": \"dead_time\", \"value\": 5e-7, \"unit\": \"s\", \"std\": 1e-9}, \
         {\"name\": \"viscous_part\", \"value\": 0.1, \"unit\": \"1\", \"std\": 0.01}]}, \
         \"failure\": {\"fault\": \"NotVerified\", \"message\": \"70 counts\"}",
    );
    let read = Identified::parse(&text).expect("a report");
    let machine = read.model.machine.machine("model").expect("a machine");
    assert!((machine.damping / (machine.kb + machine.damping) - 0.1).abs() < 1e-12);
    assert!((machine.kb + machine.damping - 0.025).abs() < 1e-12);
    let graded = read.grade.expect("a grade");
    assert_eq!(graded.grade, super::device::Grade::No);
    assert_eq!(graded.reason.as_deref(), Some("70 counts"));
    let told = |name: &str| read.parameters.iter().any(|p| p.name == name);
    assert!(told("dead_time") && told("viscous_part"));
}

#[test]
fn what_is_no_result_is_refused_with_its_place_and_never_read() {
    let cases: &[(&str, &str, &str)] = &[
        ("", "", ":1:0"),
        (FIT, "NaN", ":"),
        (FIT, "1e999", ":"),
        (FIT, "null", ":"),
        (FIT, "-1e3", "positive"),
        (FIT, "0", "positive"),
    ];
    for (text, number, says) in cases {
        let broken = text.replace("12.0", number).replace("4.3e-4", number);
        let error = Identified::parse(&broken).expect_err(&broken).to_string();
        assert!(error.contains(says), "{number}: {error}");
    }
    for length in 0..FIT.len() - 1 {
        assert!(Identified::parse(&FIT[..length]).is_err(), "{length}");
    }
    for (from, to, says) in [
        ("servoid.fit/1", "servoid.compare/1", "servoid.compare/1"),
        ("\"schema\"", "\"other\"", "schema is ``"),
        ("\"model\"", "\"other\"", "no `model`"),
        ("\"drive\": \"voltage\"", "\"drive\": \"steam\"", "`steam`"),
        (
            "[\"coulomb\"],\n    \"m",
            "[\"colomb\"],\n    \"m",
            "coulomb",
        ),
        ("\"gain\"", "\"ga,in\"", "`ga,in`"),
        ("\"std\": 0.001", "\"std\": -1", "at least 0"),
    ] {
        let error = Identified::parse(&FIT.replace(from, to)).expect_err(to);
        assert!(error.to_string().contains(says), "{to}: {error}");
    }
    let unfitted = DEVICE
        .split_once("\"outcome\"")
        .expect("a key")
        .0
        .to_owned()
        + "\"outcome\": null}";
    let error = Identified::parse(&unfitted).expect_err("no fit");
    assert!(error.to_string().contains("did not fit"), "{error}");
}

#[test]
fn numbers_that_no_motor_has_are_refused_before_anything_is_computed_from_them() {
    for (from, to) in [("58.0", "1e200"), ("4.3e-4", "1e40"), ("0.017", "1e301")] {
        let error = Identified::parse(&FIT.replace(from, to)).expect_err(to);
        assert!(error.to_string().contains("1e30"), "{error}");
    }
}
