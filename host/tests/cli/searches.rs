//! Search methods: each fits, all are compared, and ranges and budgets are kept.

use crate::contract::{has, is_comparison, is_fit, is_row, list, number, parameter};
use crate::desk::Desk;

#[test]
fn every_method_fits_within_its_budget() {
    let desk = Desk::with_recording();
    for name in servoid_engine::solve::names() {
        let fit = desk.json(&format!("fit rec.csv --algorithm {name} --budget 300"));
        is_fit(&fit);
        assert_eq!(fit["algorithm"], name);
        assert!(number(&fit, "evaluations") <= 300.0, "{fit:#}");
        let one = desk.json(&format!("fit rec.csv --algorithm {name} --budget 1"));
        is_fit(&one);
        assert_eq!(number(&one, "evaluations"), 1.0);
        assert!(
            number(&one, "cost") >= number(&fit, "cost"),
            "{name}: more work, worse result"
        );
    }
}

#[test]
fn every_cost_finds_the_motor() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --out rec.csv");
    let wanted = number(&desk.json("fit rec.csv"), "identifiable.gain_rad_s_v");
    for cost in ["squared", "iae", "iae-floored", "interval"] {
        let fit = desk.json(&format!("fit rec.csv --cost {cost}"));
        is_fit(&fit);
        let gain = number(&fit, "identifiable.gain_rad_s_v");
        assert!(
            (gain / wanted - 1.0).abs() < 1e-4,
            "{cost}: {gain}, not {wanted}"
        );
        assert!(number(&fit, "rms_counts") < 0.32, "{fit:#}");
    }
}

#[test]
fn bounds_hold() {
    let desk = Desk::with_recording();
    let bounds = [
        ("gain", 58.0, 59.0),
        ("gain", 40.0, 50.0),
        ("a1", 0.03, 0.04),
    ];
    for name in servoid_engine::solve::names() {
        for (unknown, low, high) in bounds {
            let fit = desk.json(&format!(
                "fit rec.csv --algorithm {name} --budget 200 --bounds {unknown}={low}:{high}"
            ));
            is_fit(&fit);
            let value = number(parameter(&fit, unknown), "value");
            let slack = 1e-9 * high;
            assert!(
                (low - slack..=high + slack).contains(&value),
                "{name}, {unknown}: {value}"
            );
        }
    }
}

#[test]
fn a_comparison_has_a_row_for_every_method() {
    let desk = Desk::with_recording();
    let comparison = desk.json("compare rec.csv --seeds 3 --budget 200 --seed 11 --plot c.svg");
    is_comparison(&comparison);
    assert_eq!(comparison["budget"], 200);
    assert_eq!(comparison["seeds"], serde_json::json!([11, 12, 13]));
    let rows = list(&comparison, "rows");
    let names: Vec<_> = rows
        .iter()
        .map(|row| row["algorithm"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, servoid_engine::solve::names());
    rows.iter().for_each(|row| is_row(row, 200.0));
    let rates = "gain: number, a1: number";
    rows.iter().for_each(|row| has(&row["parameters"], rates));
    assert!(desk.read("c.svg").contains("</svg>"));
}

#[test]
fn the_smallest_comparison_works() {
    let desk = Desk::with_recording();
    let comparison = desk.json("compare rec.csv --seeds 1 --budget 1 --algorithm lm,random");
    is_comparison(&comparison);
    let rows = list(&comparison, "rows");
    assert_eq!(rows.len(), 2);
    rows.iter().for_each(|row| is_row(row, 1.0));
    assert!(
        rows.iter().all(|row| number(row, "iqr_cost") == 0.0),
        "{comparison:#}"
    );
}

#[test]
fn the_largest_seed_is_a_seed() {
    let desk = Desk::with_recording();
    let last = u64::MAX;
    let comparison = desk.json(&format!(
        "compare rec.csv --seeds 2 --budget 5 --seed {last}"
    ));
    assert_eq!(comparison["seeds"], serde_json::json!([last, 0]));
    desk.done(&format!(
        "paper --seeds 2 --population 5 --iterations 2 --seed {last}"
    ));
    desk.done(&format!("demo --seed {last}"));
    desk.done(&format!(
        "simulate --seconds 1 --seed {last} --out last.csv"
    ));
}
