//! Several recordings of one motor, fitted together.

use crate::contract::{list, number, parameter};
use crate::desk::Desk;
use serde_json::Value;

/// Three recordings to fit, of other waveforms each, and two to hold out.
const FITTED: [&str; 3] = ["telegraph", "steps", "chirp"];
const HELD_OUT: [&str; 2] = ["staircase", "commissioning"];
/// RMS error of a right model, counts: the encoder's own with some room.
const FLOOR: f64 = 0.33;

fn desk() -> Desk {
    let desk = Desk::new();
    for (seed, shape) in FITTED.iter().chain(&HELD_OUT).enumerate() {
        desk.done(&format!(
            "simulate --excite {shape} --seconds 5 --hide coulomb --seed {seed} --out {shape}.csv"
        ));
    }
    desk
}

/// The recordings of a result with this role.
fn in_role<'a>(result: &'a Value, role: &str) -> Vec<&'a Value> {
    let all = list(result, "recordings").iter();
    all.filter(|recording| recording["role"] == role).collect()
}

/// RMS over all of them.
fn pooled(recordings: &[&Value]) -> f64 {
    let (squares, samples) = recordings.iter().fold((0.0, 0.0), |(squares, all), one| {
        let samples = number(one, "samples");
        let square = number(one, "rms_counts").powi(2);
        (squares + samples * square, all + samples)
    });
    (squares / samples).sqrt()
}

#[test]
fn each_recording_has_its_error_and_each_parameter_its_spread() {
    let desk = desk();
    let fit = desk.json(
        "fit telegraph.csv steps.csv chirp.csv --with coulomb --validate staircase.csv commissioning.csv",
    );
    let (fitted, held_out) = (in_role(&fit, "fitted"), in_role(&fit, "held_out"));
    let named = |recordings: &[&Value], names: &[&str]| {
        assert_eq!(recordings.len(), names.len());
        for (recording, name) in recordings.iter().zip(names) {
            assert_eq!(recording["file"], format!("{name}.csv"));
            assert!(number(recording, "rms_counts") < FLOOR, "{recording}");
        }
    };
    named(&fitted, &FITTED);
    named(&held_out, &HELD_OUT);
    for (key, recordings) in [("rms_counts", &fitted), ("validate_rms_counts", &held_out)] {
        let (said, pooled) = (number(&fit, key), pooled(recordings));
        assert!((said - pooled).abs() < 1e-9, "{key}: {said}, {pooled}");
    }
    for name in ["gain", "a1", "coulomb.torque"] {
        let parameter = parameter(&fit, name);
        let part = number(parameter, "spread") / number(parameter, "value");
        assert!(part > 0.0 && part < 1e-3, "{parameter}");
    }
}

#[test]
fn no_order_of_the_recordings_changes_the_motor() {
    let desk = desk();
    let gain = |line: &str| number(parameter(&desk.json(line), "gain"), "value");
    let one = gain("fit telegraph.csv steps.csv chirp.csv --with coulomb");
    let other = gain("fit chirp.csv telegraph.csv steps.csv --with coulomb");
    assert!((one / other - 1.0).abs() < 1e-6, "{one}, {other}");
}

#[test]
fn recordings_together_determine_what_the_worst_of_them_does_not() {
    let desk = desk();
    let std = |line: &str| number(parameter(&desk.json(line), "coulomb.torque"), "std");
    let together = std("fit telegraph.csv steps.csv chirp.csv --with coulomb");
    for shape in FITTED {
        let alone = std(&format!("fit {shape}.csv --with coulomb"));
        assert!(together < 2.0 * alone, "{shape}: {together}, {alone}");
    }
}

#[test]
fn a_diagnosis_of_several_recordings_names_what_one_names() {
    let desk = desk();
    let diagnosis =
        desk.json("diagnose telegraph.csv steps.csv --validate chirp.csv commissioning.csv");
    crate::diagnose::is_diagnosis(&diagnosis);
    assert_eq!(
        diagnosis["final"]["effects"],
        serde_json::json!(["coulomb"])
    );
    assert_eq!(in_role(&diagnosis, "fitted").len(), 2);
    assert_eq!(in_role(&diagnosis, "held_out").len(), 2);
    for recording in list(&diagnosis, "recordings") {
        assert!(number(recording, "rms_counts") < FLOOR, "{recording}");
    }
}

#[test]
fn a_recording_that_is_fitted_is_not_held_out_as_well() {
    let desk = desk();
    let both = desk.done(
        "fit telegraph.csv --with coulomb --validate steps.csv telegraph.csv --json both.json",
    );
    assert!(both.stderr.contains("--validate"), "{both}");
    desk.done("fit telegraph.csv --with coulomb --validate steps.csv --json one.json");
    let error = |name: &str| {
        let fit = desk.read_json(name);
        number(&fit, "validate_rms_counts")
    };
    assert_eq!(error("both.json"), error("one.json"));
}

#[test]
fn recordings_that_do_not_belong_together_are_refused() {
    let desk = desk();
    std::fs::create_dir(desk.path("other")).expect("a folder");
    desk.done("simulate --seconds 5 --counts-per-rev 500 --out other/coarse.csv");
    desk.write("again.csv", desk.read("telegraph.csv"));
    let differ = [
        "telegraph.csv",
        "coarse.csv",
        "counts per revolution",
        "one encoder",
    ];
    let copies = ["telegraph.csv", "again.csv", "the same samples", "once"];
    for verb in ["fit", "diagnose"] {
        let line = |other: &str| format!("{verb} telegraph.csv {other} --validate steps.csv");
        desk.refused(&line("other/coarse.csv"), 1, &differ);
        desk.refused(&line("again.csv"), 1, &copies);
    }
}

/// Amplifiers with another offset at each recording, V.
const OFFSETS_V: [f64; 3] = [0.1, -0.25, 0.4];

#[test]
fn each_recording_may_have_an_offset_of_its_own() {
    let desk = Desk::new();
    for (seed, (shape, offset)) in FITTED.iter().zip(OFFSETS_V).enumerate() {
        desk.done(&format!(
            "simulate --excite {shape} --seconds 5 --hide coulomb --hide offset_voltage:offset={offset} --seed {seed} \
             --out {shape}.csv"
        ));
    }
    let line = "fit telegraph.csv steps.csv chirp.csv --with coulomb,offset_voltage";
    assert!(number(&desk.json(line), "rms_counts") > 1000.0);
    let fit = desk.json(&format!("{line} --own offset_voltage.voltage"));
    assert!(number(&fit, "rms_counts") < FLOOR, "{fit}");
    for (recording, offset) in in_role(&fit, "fitted").iter().zip(OFFSETS_V) {
        assert!(number(recording, "rms_counts") < FLOOR, "{recording}");
        let own = &list(recording, "own")[0];
        assert_eq!(own["name"], "offset_voltage.voltage");
        let away = (number(own, "value") - offset) / number(own, "std");
        assert!(away.abs() < 4.0, "{own}: {offset} V is hidden");
    }
    let mean = parameter(&fit, "offset_voltage.voltage");
    let hidden = OFFSETS_V.iter().sum::<f64>() / OFFSETS_V.len() as f64;
    assert!((number(mean, "value") - hidden).abs() < 1e-4, "{mean}");
}

#[test]
fn what_no_recording_can_have_for_itself_is_refused() {
    let desk = desk();
    let all = "fit telegraph.csv steps.csv";
    for (line, why) in [
        ("fit steps.csv --own gain", "several recordings"),
        (&format!("{all} --own gian"), "did you mean `gain`"),
        (&format!("{all} --own gain --cost iae"), "leave out --cost"),
    ] {
        desk.refused(line, 2, &[why]);
    }
}
