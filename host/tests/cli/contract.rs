//! The shape of the JSON that scripts rely on: every key of the contract, each with its type.

use crate::desk::Desk;
use serde_json::Value;

/// The object `value` has every one of `keys`, each with its type, as in `name: text, std: number?`; `number?` may be null.
pub fn has(value: &Value, keys: &str) {
    for key in keys.split(", ") {
        let (key, is) = key.split_once(": ").expect("a key and its type");
        let found = value
            .get(key)
            .unwrap_or_else(|| panic!("no key `{key}` in {value:#}"));
        let number = found.as_f64().is_some_and(f64::is_finite);
        let fits = match is {
            "text" => found.as_str().is_some_and(|text| !text.is_empty()),
            "number" => number,
            "number?" => number || found.is_null(),
            "flag" => found.is_boolean(),
            "object" => found.is_object(),
            "list" => found.is_array(),
            other => panic!("there is no type `{other}`"),
        };
        assert!(fits, "`{key}` is {found}, not {is}");
    }
}

/// The number at a path like `identifiable.a1_s`.
pub fn number(value: &Value, path: &str) -> f64 {
    let found = path.split('.').fold(value, |value, key| &value[key]);
    found
        .as_f64()
        .unwrap_or_else(|| panic!("`{path}` is no number in {value:#}"))
}

/// The list behind a key.
pub fn list<'a>(value: &'a Value, key: &str) -> &'a [Value] {
    value[key]
        .as_array()
        .unwrap_or_else(|| panic!("`{key}` is no list in {value:#}"))
}

/// The parameter of a fit with this name.
pub fn parameter<'a>(fit: &'a Value, name: &str) -> &'a Value {
    list(fit, "parameters")
        .iter()
        .find(|parameter| parameter["name"] == name)
        .unwrap_or_else(|| panic!("no parameter `{name}` in {fit:#}"))
}

/// A fitted parameter, with its uncertainty.
pub fn is_parameter(parameter: &Value) {
    has(
        parameter,
        "name: text, value: number, unit: text, std: number?, identifiable: flag",
    );
}

/// `servoid.fit/1` of a motor driven by a voltage.
pub fn is_fit(fit: &Value) {
    assert_eq!(fit["schema"], "servoid.fit/1");
    has(
        fit,
        "algorithm: text, seed: number, evaluations: number, cost: number, cost_kind: text, \
         rms_counts: number, validate_rms_counts: number?, effects: list, parameters: list, \
         identifiable: object",
    );
    for parameter in list(fit, "parameters") {
        is_parameter(parameter);
        // What is undetermined cannot be called determined.
        assert!(
            !(parameter["std"].is_null() && parameter["identifiable"] == true),
            "{parameter}"
        );
    }
    let response = "gain_rad_s_v: number, a1_s: number, a2_s2: number";
    has(&fit["identifiable"], response);
    are_margins(&fit["margins"]);
}

/// `servoid.compare/1`.
pub fn is_comparison(comparison: &Value) {
    assert_eq!(comparison["schema"], "servoid.compare/1");
    has(comparison, "budget: number, seeds: list, rows: list");
}

/// A row of `compare` whose runs all found a finite cost within `budget`.
pub fn is_row(row: &Value, budget: f64) {
    has(
        row,
        "algorithm: text, median_cost: number, best_cost: number, iqr_cost: number, \
         median_evaluations_to_1pct: number?, wall_s: number, parameters: object, curve: list",
    );
    are_margins(&row["margins"]);
    let parameters = row["parameters"].as_object().expect("an object");
    assert!(
        parameters.values().all(Value::is_number) && !parameters.is_empty(),
        "{row:#}"
    );

    let (best, median) = (number(row, "best_cost"), number(row, "median_cost"));
    assert!(
        0.0 <= best && best <= median && number(row, "iqr_cost") >= 0.0,
        "{row:#}"
    );
    let curve: Vec<[f64; 2]> = serde_json::from_value(row["curve"].clone()).expect("pairs");
    let falls = |pair: &[[f64; 2]]| pair[0][0] < pair[1][0] && pair[0][1] >= pair[1][1];
    assert!(
        curve.windows(2).all(falls),
        "the median of the best cost rises\n{row:#}"
    );
    let [evaluations, cost] = *curve.last().expect("a point");
    assert!(evaluations <= budget && cost == median, "{row:#}");
}

/// Gain margin in dB (null where infinite) and phase margin in degrees.
pub fn are_margins(margins: &Value) {
    has(margins, "gain_db: number?, phase_deg: number");
}

#[test]
fn every_verb_tells_the_version_of_the_program() {
    let desk = Desk::new();
    let version = desk.done("--version").stdout;
    assert!(version.starts_with("servoid "), "{version}");
    for verb in [
        "fit",
        "diagnose",
        "compare",
        "demo",
        "simulate",
        "paper",
        "completions",
    ] {
        assert_eq!(desk.done(&format!("{verb} --version")).stdout, version);
    }
}
