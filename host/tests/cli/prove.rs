//! `servoid prove`: cases, shards, a file that grows, and their joint table. Nothing is hidden in them, which is
//! quick to prove; none of these journeys says how good the diagnosis is.

use crate::contract::{has, list};
use crate::desk::Desk;
use serde_json::Value;

const CASES: &str = "prove --hidden none --cases 2";

/// The lines of a file of cases, without what differs from run to run.
fn cases(desk: &Desk, name: &str) -> Vec<Value> {
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
    assert_eq!(cases(&desk, "cut.jsonl"), cases(&desk, "whole.jsonl"));
    let again = desk.done("prove --hidden none --only 1 --out one.jsonl");
    assert!(again.stdout.contains("1 case of seed 1"), "{again}");
    assert_eq!(cases(&desk, "one.jsonl"), cases(&desk, "whole.jsonl")[1..]);
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
        &cases(&desk, "p.jsonl")[0],
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
