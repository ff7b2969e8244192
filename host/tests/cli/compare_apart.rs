//! A comparison whose seeds are run apart.

use crate::desk::Desk;
use crate::repeatable::without_times;

const OPTIONS: &str = "--algorithm lm,pso,random --budget 60";

/// Five seeds in two files.
fn apart() -> Desk {
    let desk = Desk::with_recording();
    desk.done(&format!(
        "compare rec.csv {OPTIONS} --seed 11 --seeds 2 --out a.json"
    ));
    desk.done(&format!(
        "compare rec.csv {OPTIONS} --seed 13 --seeds 3 --out b.json"
    ));
    desk
}

#[test]
fn seeds_that_were_run_apart_are_one_comparison() {
    let desk = apart();
    // Without the computing time, which ends a line.
    let told = |line: &str, json: &str| {
        let outcome = desk.done(&format!("compare rec.csv {OPTIONS} {line} --json {json}"));
        let lines = outcome.stdout.lines();
        let table: Vec<String> = lines.map(|line| line.chars().take(72).collect()).collect();
        let mut document = desk.read_json(json);
        without_times(&mut document);
        (table, document.to_string())
    };
    let together = told("--seed 11 --seeds 5", "together.json");
    assert_eq!(told("--merge a.json b.json", "merged.json"), together);
    let seconds = |name: &str| desk.read_json(name)["rows"][1]["wall_s"].as_f64();
    let sum = seconds("a.json").zip(seconds("b.json")).map(|(a, b)| a + b);
    assert_eq!(seconds("merged.json"), sum);
}

#[test]
fn runs_without_a_finite_cost_are_kept_too() {
    let desk = Desk::with_recording();
    // Far from any motor, one evaluation.
    let options = "--algorithm random --budget 1 --bounds gain=1e200:1e250";
    let mut whole = desk.json(&format!("compare rec.csv {options} --seeds 2 --out a.json"));
    let mut merged = desk.json(&format!("compare rec.csv {options} --merge a.json"));
    without_times(&mut whole);
    without_times(&mut merged);
    assert_eq!(merged, whole);
}

#[test]
fn files_of_other_comparisons_are_refused() {
    let desk = apart();
    desk.done("simulate --seconds 2 --seed 2 --out other.csv");
    desk.write("torn.json", &desk.read("a.json")[..200]);
    let all = "rec.csv --algorithm lm,pso,random";
    for (line, code, says) in [
        (
            "rec.csv --algorithm lm --budget 60 --merge a.json",
            2,
            "--algorithm lm,pso,random",
        ),
        (&*format!("{all} --merge a.json"), 2, "--budget 60"),
        (
            &*format!("{all} --budget 60 --with coulomb --merge a.json"),
            2,
            "the unknowns gain, a1",
        ),
        (
            &*format!("{all} --budget 60 --cost iae --merge a.json"),
            2,
            "another recording, cost",
        ),
        (
            &*format!("other.csv {OPTIONS} --merge a.json"),
            2,
            "another recording, cost",
        ),
        (
            &*format!("rec.csv {OPTIONS} --merge a.json b.json a.json"),
            2,
            "seed 11",
        ),
        (
            &*format!("rec.csv {OPTIONS} --json a.json --merge a.json"),
            2,
            "a file of --merge",
        ),
        ("rec.csv --seeds 3 --merge a.json", 2, "--seeds"),
        ("rec.csv --out motor.toml", 2, "the motor file"),
        (
            &*format!("rec.csv {OPTIONS} --merge torn.json"),
            1,
            "torn.json",
        ),
        (
            &*format!("rec.csv {OPTIONS} --merge none.json"),
            1,
            "none.json",
        ),
        (
            &*format!("rec.csv {OPTIONS} --merge rec.csv"),
            1,
            "compare --out",
        ),
    ] {
        desk.refused(&format!("compare {line}"), code, &[says]);
    }
}
