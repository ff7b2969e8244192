//! `servoid prove`: cases, shards, a file that grows, and their joint table. Nothing is hidden in them, which is
//! quick to prove; none of these journeys says how good the diagnosis is.

use crate::contract::{has, list};
use crate::desk::Desk;
use crate::width::fits_a_terminal;
use serde_json::Value;
use testing::length::cases;

const CASES: &str = "prove --hidden none --cases 2";

/// The lines of a file of cases, without what differs from run to run.
fn lines(desk: &Desk, name: &str) -> Vec<Value> {
    let text = desk.read(name);
    let lines = text.lines().skip(1);
    let mut cases: Vec<Value> = lines
        .map(|line| serde_json::from_str(line).expect("a line of JSON"))
        .collect();
    for case in &mut cases {
        case["seconds"] = 0.into();
    }
    cases.sort_by_key(|case| case["case"].as_u64());
    cases
}

/// The JSON without times.
fn timeless(mut json: Value) -> Value {
    for group in json["groups"].as_array_mut().expect("groups") {
        group["seconds"] = Value::Null;
    }
    json
}

#[test]
fn shards_and_a_cut_file_come_to_the_same_as_the_whole() {
    let desk = Desk::new();
    let whole = timeless(desk.json(&format!("{CASES} --out whole.jsonl")));
    desk.done(&format!("{CASES} --shard 1/2 --out a.jsonl"));
    desk.done(&format!("{CASES} --shard 2/2 --out b.jsonl"));
    let joint = timeless(desk.json("prove --merge b.jsonl a.jsonl b.jsonl"));
    assert_eq!(joint, whole);

    let text = desk.read("whole.jsonl");
    desk.write("cut.jsonl", &text[..text.len() - 20]);
    let resumed = timeless(desk.json(&format!("{CASES} --resume cut.jsonl")));
    assert_eq!(resumed, whole);
    assert_eq!(lines(&desk, "cut.jsonl"), lines(&desk, "whole.jsonl"));
    let again = desk.done("prove --hidden none --only 1 --out one.jsonl");
    assert!(again.stdout.contains("1 case of seed 1"), "{again}");
    assert_eq!(lines(&desk, "one.jsonl"), lines(&desk, "whole.jsonl")[1..]);
}

#[test]
fn the_table_says_what_was_proved() {
    let desk = Desk::new();
    let outcome = desk.done("prove --hidden none --cases 1 --seed 5 --json p.json --out p.jsonl");
    for line in ["1 case of seed 5", "nothing hidden", "all cases", "seconds"] {
        assert!(outcome.stdout.contains(line), "{outcome}");
    }
    let width = |line: &str| line.chars().count();
    assert!(
        outcome.stdout.lines().all(|line| width(line) <= 80),
        "{outcome}"
    );
    let json = desk.read_json("p.json");
    assert_eq!(json["schema"], "servoid.prove/1");
    has(
        &json,
        "version: text, set_up: object, cases: number, failures: list, shares: list, groups: list, \
         size_errors_percent: object, shape_errors_percent: object, confusions: list, \
         interrupted: flag",
    );
    let group = &list(&json, "groups")[0];
    has(
        group,
        "hidden: number, cases: number, detectable: number, seconds: object, refits: object",
    );
    let share = &list(group, "shares")[0];
    has(share, "name: text, count: number, of: number, rate: object");
    has(
        &lines(&desk, "p.jsonl")[0],
        "seed: number, case: number, redrawn: number, motor: object, hidden: list, \
         counts_per_rev: number, excitation: text, amplitude: number, base: object, \
         detectable: flag, named: list, verdict: text, last: object, parameters: list, \
         evaluations: number?, refits: number, seconds: number",
    );
}

#[test]
fn wrong_use_is_refused_before_the_work() {
    let desk = Desk::new();
    desk.done("prove --hidden none --cases 1 --out one.jsonl");
    desk.done("prove --hidden none --cases 1 --seed 2 --out two.jsonl");
    desk.write("other.csv", "t_s,voltage_v\n0,1\n");
    let cases: &[(&str, &[&str])] = &[
        ("--shard 3/2", &["--shard", "1 <= i <= n"]),
        ("--shard half", &["--shard", "2/3"]),
        ("--cases 0", &["--cases"]),
        ("--hidden three", &["--hidden", "two"]),
        ("--excite chirp", &["--excite", "mixed"]),
        ("--effect colomb", &["--effect", "coulomb"]),
        ("--out one.jsonl", &["--out one.jsonl", "--resume"]),
        (
            "--out missing/file",
            &["--out missing/file", "make it first"],
        ),
        ("--out a.jsonl --json a.jsonl", &["--json a.jsonl", "--out"]),
        ("--out a.jsonl --resume one.jsonl", &["--out", "--resume"]),
        ("--resume nowhere", &["--resume nowhere", "--out"]),
        (
            "--resume one.jsonl --seed 2 --hidden none",
            &["--resume one.jsonl", "--seed 1, not 2"],
        ),
        (
            "--resume one.jsonl --hidden two --excite mixed --effect delay",
            &[
                "--hidden none, not two",
                "--excite commissioning, not mixed",
                "--effect all, not delay",
            ],
        ),
        (
            "--merge one.jsonl two.jsonl",
            &["--merge two.jsonl", "--seed 2, not 1"],
        ),
        ("--merge nowhere", &["--merge nowhere"]),
        ("--merge one.jsonl --shard 1/2", &["--merge", "--shard"]),
        ("--merge one.jsonl --json one.jsonl", &["--json one.jsonl"]),
    ];
    for (flags, says) in cases {
        desk.refused(&format!("prove {flags}"), 2, says);
    }
    for flags in ["--resume other.csv", "--merge one.jsonl other.csv"] {
        desk.refused(
            &format!("prove {flags}"),
            1,
            &["other.csv:1: ", "no file of servoid prove"],
        );
    }
}

/// Least coverage of the 95 % intervals that so few recordings must leave possible, and most of the spread of the errors.
const COVERAGE: f64 = 0.92;
const SPREAD: f64 = 1.6;

/// Every parameter of every drive and encoder, and of effects: what is stated as 95 % may be that.
#[test]
fn stated_intervals_hold_the_truth_as_often_as_they_say() {
    let desk = Desk::new();
    let runs = ["", "--effect coulomb windage delay offset_voltage"];
    for what in &runs[..cases(runs.len(), 1)] {
        let line = format!("prove --coverage --cases 30 --seed 20261125 --json c.json {what}");
        let outcome = desk.done(&line);
        println!("{outcome}");
        fits_a_terminal(&line, &outcome.stdout);
        let json = desk.read_json("c.json");
        assert_eq!(json["schema"], "servoid.coverage/1");
        has(
            &json,
            "version: text, seed: number, recordings: number, failures: number, conditions: list, interrupted: flag",
        );
        assert_eq!(json["failures"], 0);
        assert_eq!(json["recordings"], 30 * list(&json, "conditions").len());
        for condition in list(&json, "conditions") {
            holds(condition);
        }
    }
}

fn holds(condition: &serde_json::Value) {
    for covered in list(condition, "parameters") {
        let z = list(covered, "z").len();
        let what = format!(
            "{}, {}, {}: {covered}",
            condition["excitation"], condition["counts_per_rev"], condition["effect"]
        );
        // What a triangle or a coarse encoder hardly shows need not be stated.
        assert!(z >= 20, "{what}");
        let most = covered["within_2"]["rate"]["high"]
            .as_f64()
            .expect("a number");
        assert!(most >= COVERAGE, "{what}");
        let spread = covered["z_sd"].as_f64().expect("a number");
        assert!(spread <= SPREAD, "{what}");
    }
}

#[test]
fn parts_of_a_coverage_are_those_of_the_whole() {
    let desk = Desk::new();
    let all = desk.json("prove --coverage --cases 2 --seed 3");
    let errors = |json: &serde_json::Value| -> Vec<f64> {
        let conditions = list(json, "conditions");
        let covered = conditions.iter().flat_map(|c| list(c, "parameters"));
        let z = covered.flat_map(|p| list(p, "z"));
        z.filter_map(serde_json::Value::as_f64).collect()
    };
    let sorted = |mut errors: Vec<f64>| {
        errors.sort_by(f64::total_cmp);
        errors
    };
    let whole = sorted(errors(&all));
    let part = |shard: &str, file: &str| {
        desk.done(&format!(
            "prove --coverage --cases 2 --seed 3 --shard {shard} --json {file}"
        ));
        desk.read_json(file)
    };
    let (one, other) = (part("1/2", "one.json"), part("2/2", "other.json"));
    let parts = [errors(&one), errors(&other)].concat();
    assert_eq!(sorted(parts), whole);
    // Joined they are the whole, with its table and its drawing.
    let merge = "prove --coverage --merge one.json other.json";
    desk.done(&format!("{merge} --json joint.json --plot joint.svg"));
    let joint = desk.read_json("joint.json");
    assert_eq!(sorted(errors(&joint)), whole);
    assert_eq!(joint["recordings"], all["recordings"]);
    assert!(desk.read("joint.svg").contains("on the diagonal"));
    desk.done("prove --coverage --cases 1 --seed 4 --json strange.json");
    desk.refused(
        "prove --coverage --merge one.json strange.json",
        2,
        &["strange.json", "another seed"],
    );
    desk.write("broken.json", "{\"schema\": ");
    desk.refused("prove --coverage --merge broken.json", 1, &["broken.json"]);
    desk.refused(
        &format!("{merge} --plot one.json"),
        2,
        &["a file of --merge"],
    );
    for flags in ["--hidden one", "--out x.jsonl", "--only 1", "--law other"] {
        desk.refused(&format!("prove --coverage {flags}"), 2, &["--coverage"]);
    }
}
