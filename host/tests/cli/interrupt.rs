//! Ctrl-C: the work ends soon, with what it has.
#![cfg(unix)]

use std::thread::sleep;
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::contract::{has, is_fit, list};
use crate::desk::{Desk, Outcome, PATIENCE, ended, signal};

/// Time to get to work before the signal. Too short only means that there is less to report.
const AT_WORK: Duration = Duration::from_millis(1500);

/// Runs `line`, which would take hours, and interrupts it.
fn interrupted(desk: &Desk, line: &str) -> Outcome {
    interrupted_when(desk, line, || true)
}

/// The same, not before there is `enough` done.
fn interrupted_when(desk: &Desk, line: &str, enough: impl Fn() -> bool) -> Outcome {
    let mut child = desk.spawn(line);
    sleep(AT_WORK);
    let asked = Instant::now();
    while !enough() && asked.elapsed() < PATIENCE {
        sleep(Duration::from_millis(20));
    }
    assert!(
        child.try_wait().expect("a child").is_none(),
        "{line}: over before the signal"
    );
    signal("-INT", &child);
    let outcome = ended(child, line);
    outcome.is_refusal(1, &["stopped by the user", "best so far"]);
    outcome
}

#[test]
fn a_stopped_fit_keeps_its_best() {
    let desk = Desk::with_recording();
    let outcome = interrupted(
        &desk,
        "fit rec.csv --algorithm random --budget 1000000000 --json fit.json",
    );
    assert!(outcome.stdout.contains("counts RMS"), "{outcome}");
    let fit = desk.read_json("fit.json");
    is_fit(&fit);
    assert_eq!(fit["interrupted"], true);
}

#[test]
fn a_stopped_comparison_keeps_what_it_has_and_makes_nothing_up() {
    let desk = Desk::with_recording();
    let line = "compare rec.csv --algorithm random,pso --seeds 1000 --budget 1000000 --json c.json --plot c.svg --out r.json";
    let outcome = interrupted(&desk, line);
    assert!(outcome.stdout.contains("random"), "{outcome}");
    // Half of a seed's run is no run of it.
    assert!(!desk.path("r.json").exists());
    let comparison = desk.read_json("c.json");
    let rows = list(&comparison, "rows");
    has(&rows[0], "best_cost: number, median_cost: number");
    assert_eq!(rows[1]["algorithm"], "pso");
    assert!(
        rows[1]["best_cost"].is_null(),
        "it never began: {comparison:#}"
    );
    assert_eq!(
        rows[1]["parameters"],
        serde_json::json!({}),
        "{comparison:#}"
    );
}

#[test]
fn a_stopped_paper_keeps_what_it_has() {
    let desk = Desk::new();
    let line = "paper --seeds 10000 --iterations 100000 --json p.json --plots .";
    let outcome = interrupted(&desk, line);
    assert!(outcome.stdout.contains("Table 1"), "{outcome}");
    assert!(desk.read("bode.svg").contains("</svg>"));
    let paper = desk.read_json("p.json");
    // Which method comes first is not the point: the work that was done is there.
    let done = |row: &&Value| row["best_cost"].is_number();
    let row = list(&paper, "rows").iter().find(done).expect("a best cost");
    has(row, "parameters: object");
    assert_ne!(row["parameters"], serde_json::json!({}), "{row:#}");
}

#[test]
fn a_stopped_proof_counts_the_cases_that_are_done() {
    let desk = Desk::new();
    let line = "prove --hidden none --cases 100000 --out p.jsonl --json p.json";
    // A head and a case: a busy machine has none after a fixed time.
    let enough = || desk.lines_of("p.jsonl") >= 2;
    let outcome = interrupted_when(&desk, line, enough);
    assert!(outcome.stdout.contains("nothing hidden"), "{outcome}");
    let table = desk.read_json("p.json");
    assert_eq!(table["interrupted"], true);
    let done = desk.read("p.jsonl").lines().count() - 1;
    assert_eq!(table["cases"], done);
    assert!(done > 0);
}

#[test]
fn a_stopped_diagnosis_keeps_its_best_and_does_not_call_it_final() {
    let desk = Desk::with_pair("--excite telegraph --seconds 60 --hide lugre --hide cogging");
    let outcome = interrupted(&desk, "diagnose rec.csv --validate other.csv --json d.json");
    assert!(outcome.stdout.contains("error ladder"), "{outcome}");
    let diagnosis = desk.read_json("d.json");
    crate::diagnose::is_diagnosis(&diagnosis);
    assert_eq!(diagnosis["interrupted"], true);
    assert_ne!(diagnosis["verdict"], "unexplained");
}
