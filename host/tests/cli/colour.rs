//! Colour is for terminals: it changes no word, and is nowhere else.

use crate::desk::{Desk, Outcome};

/// The escape character that begins every colour.
const ESCAPE: char = '\u{1b}';

/// Verbs whose results carry colour on a terminal.
const LINES: [&str; 4] = [
    "diagnose friction.csv",
    "fit friction.csv --with coulomb",
    "compare friction.csv --seeds 2 --budget 40 --algorithm pso,firefly",
    "fit missing.csv",
];

fn desk() -> Desk {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --hide coulomb --out friction.csv");
    desk
}

fn run(desk: &Desk, line: &str, variable: &str) -> Outcome {
    let mut command = desk.command(line);
    command.env_clear().env(variable, "1");
    Outcome::new(line, command.output().expect("servoid starts"))
}

/// Both streams, without the computing time that ends a line of `compare`.
fn words(outcome: &Outcome) -> String {
    let all = format!("{}{}", outcome.stdout, outcome.stderr);
    let timed = outcome.line.starts_with("compare");
    let timeless = |line: &str| match line.rsplit_once("   ") {
        Some((text, seconds)) if timed && seconds.parse::<f64>().is_ok() => text.to_owned(),
        _ => line.to_owned(),
    };
    all.lines().map(timeless).collect::<Vec<_>>().join("\n")
}

/// A text without its colours.
fn plain(text: &str) -> String {
    let mut parts = text.split(ESCAPE);
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |all, part| {
        all + part.split_once('m').map_or("", |(_, rest)| rest)
    })
}

#[test]
fn a_terminal_gets_the_same_words_in_colour_and_nothing_else_gets_any() {
    let desk = desk();
    for line in LINES {
        let piped = run(&desk, line, "UNSET");
        let forced = run(&desk, line, "CLICOLOR_FORCE");
        assert!(!piped.stdout.contains(ESCAPE), "{piped}");
        assert!(!piped.stderr.contains(ESCAPE), "{piped}");
        let (coloured, code) = (words(&forced), forced.code);
        assert!(coloured.contains(ESCAPE), "{forced}");
        assert_eq!(words(&piped), plain(&coloured), "{line}");
        assert_eq!(piped.code, code, "{line}");
    }
}

#[test]
fn a_user_who_wants_none_gets_none() {
    let desk = desk();
    for line in LINES {
        let outcome = run(&desk, line, "NO_COLOR");
        assert!(!words(&outcome).contains(ESCAPE), "{outcome}");
    }
}
