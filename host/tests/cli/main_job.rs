//! The main job, from a recording to a model that explains it.

use crate::contract::{is_fit, number, parameter};
use crate::desk::Desk;
use crate::report::is_alone;
use crate::width::fits_a_terminal;
use shared::effects::Kind;

#[test]
fn the_demo_writes_one_page_that_fetches_nothing() {
    let desk = Desk::new();
    let outcome = desk.done("demo --out page.html");
    assert!(
        outcome.stdout.contains("counts RMS") && outcome.stdout.contains("page.html"),
        "{outcome}"
    );
    is_alone(&desk.read("page.html"));
    assert_eq!(desk.listing().len(), 1, "the page is all that is written");
}

#[test]
fn the_demo_has_a_usual_name_for_its_page() {
    let desk = Desk::new();
    is_fit(&desk.json("demo"));
    assert!(
        desk.read("servoid-demo.html")
            .starts_with("<!doctype html>")
    );
}

#[test]
fn the_demo_hides_what_it_is_told_and_finds_it() {
    let desk = Desk::new();
    let outcome = desk.done("demo --hide coulomb:strength=2 --out page.html --json demo.json");
    for word in [
        "Hidden in it",
        "coulomb",
        "error ladder",
        "the bench knows the truth",
        "the diagnosis named it",
        "coulomb.torque",
    ] {
        assert!(outcome.stdout.contains(word), "{word}\n{outcome}");
    }
    let demo = desk.read_json("demo.json");
    is_fit(&demo);
    crate::diagnose::is_diagnosis(&demo["diagnosis"]);
    assert_eq!(demo["named"], true);
    for error in demo["parameter_errors"].as_array().expect("a list") {
        assert!(number(error, "percent") < 0.1, "{error}");
    }
    assert!(number(&demo, "gain_error_percent") < 0.01);
    let page = desk.read("page.html");
    for heading in [
        "The error falls",
        "Measured and model",
        "Where it fails",
        "The truth",
    ] {
        assert!(page.contains(heading), "the page tells {heading}");
    }
    desk.refused("demo --hide colomb", 2, &["--hide", "coulomb"]);
    desk.refused("demo --hide coulomb --blind", 2, &["--hide", "--blind"]);
}

#[test]
fn a_blind_demo_reveals_its_secret_at_the_end() {
    let line = "demo --blind --seed 4 --out page.html";
    let text = Desk::new().done(line).stdout;
    fits_a_terminal(line, &text);
    let told = "the bench knows the truth: hidden was ";
    let (before, after) = text.split_once(told).unwrap_or_else(|| panic!("{text}"));
    assert!(
        before.contains("something that is told at the end"),
        "{text}"
    );
    let secret: String = after
        .chars()
        .take_while(|c| *c == '_' || c.is_alphanumeric())
        .collect();
    assert!(Kind::by_name(&secret).is_some(), "`{secret}` of {text}");
    let (begin, _) = before
        .split_once("missing_effects")
        .unwrap_or_else(|| panic!("{text}"));
    assert!(!begin.contains(&secret), "{text}");
}

/// Friction is hidden; the linear motor fails on it, and the model with friction does not.
#[test]
fn a_hidden_friction_spoils_the_linear_fit_and_the_named_effect_repairs_it() {
    let desk = Desk::new();
    desk.done("simulate --hide coulomb:torque=0.002 --out rec.csv");
    desk.done("simulate --hide coulomb:torque=0.002 --seed 2 --out other.csv");

    let linear = desk.json("fit rec.csv --validate other.csv");
    is_fit(&linear);
    assert!(number(&linear, "rms_counts") > 100.0, "{linear:#}");
    assert!(number(&linear, "validate_rms_counts") > 100.0, "{linear:#}");

    let facts = "--known resistance_ohm=2.3 --known kt_n_m_a=0.017";
    let repaired = desk.json(&format!(
        "fit rec.csv --with coulomb --validate other.csv {facts}"
    ));
    is_fit(&repaired);
    assert_eq!(repaired["effects"], serde_json::json!(["coulomb"]));
    for error in ["rms_counts", "validate_rms_counts"] {
        assert!(
            (0.26..=0.30).contains(&number(&repaired, error)),
            "{error} of {repaired:#}"
        );
    }
    let torque = parameter(&repaired, "coulomb.torque");
    assert_eq!(torque["unit"], "N*m");
    assert!(
        (number(torque, "value") / 0.002 - 1.0).abs() < 1e-3,
        "{torque}"
    );
}

/// Cogging makes free runs chaotic, and regression knows nothing of it.
#[test]
fn a_model_with_the_hidden_effect_is_never_worse_than_one_without() {
    let desk = Desk::new();
    for hidden in ["cogging", "stribeck", "windage", "compliance"] {
        desk.done(&format!("simulate --hide {hidden} --out rec.csv"));
        desk.done(&format!(
            "simulate --hide {hidden} --seed 2 --out other.csv"
        ));
        let fit = desk.json(&format!("fit rec.csv --with {hidden} --validate other.csv"));
        let ladder = fit["ladder"].as_array().expect("a list");
        for error in ["rms_counts", "validate_rms_counts"] {
            assert!(number(&fit, error) < 0.33, "{hidden}: {error} of {fit:#}");
            assert!(number(&ladder[0], error) > number(&fit, error), "{hidden}");
        }
    }
}

#[test]
fn a_fit_prints_a_table_and_writes_its_json_and_its_picture() {
    let desk = Desk::with_recording();
    desk.done("simulate --seed 2 --out other.csv");
    let outcome = desk.done("fit rec.csv --validate other.csv --json fit.json --plot fit.svg");
    for word in [
        "counts RMS",
        "held-out error",
        "gain",
        "a1",
        "not separable",
    ] {
        assert!(outcome.stdout.contains(word), "no {word}\n{outcome}");
    }
    assert!(desk.read("fit.svg").contains("</svg>"));
    let written = desk.read_json("fit.json");
    is_fit(&written);
    assert_eq!(
        written,
        desk.json("fit rec.csv --validate other.csv --plot fit.svg")
    );
}

#[test]
fn quiet_leaves_the_result_only() {
    let desk = Desk::with_recording();
    for line in [
        "fit rec.csv --plot a.svg",
        "compare rec.csv --seeds 2 --budget 20 --plot b.svg",
    ] {
        let outcome = desk.done(&format!("{line} --quiet"));
        assert_eq!(outcome.stderr, "", "{outcome}");
        assert!(!outcome.stdout.is_empty(), "{outcome}");
    }
}

#[test]
fn a_log_that_begins_in_motion_is_fitted_as_well_as_a_whole_one() {
    let desk = Desk::new();
    desk.done("simulate --hide coulomb --out rec.csv");
    let whole = desk.read("rec.csv");
    let (heading, rows): (Vec<&str>, Vec<&str>) = whole
        .lines()
        .partition(|line| !line.starts_with(|c: char| c.is_ascii_digit()));
    // In the middle of each experiment the motor turns.
    for from in [5_057, 8_300, 12_345] {
        let cut = [&heading[..], &rows[from..]].concat().join("\n");
        desk.write("cut.csv", cut);
        let fit = desk.json("fit cut.csv --with coulomb");
        assert!(number(&fit, "rms_counts") < 0.5, "from row {from}: {fit:#}");
    }
}
