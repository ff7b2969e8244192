//! What a test does not do on this machine, said where it is seen.
//!
//! A runner keeps what a passing test prints to itself. So each note goes straight to the process's stderr, and to the file
//! `SERVOID_NOTES` as well if that is set: `scripts/test` counts what is in it at its end.

use std::fs::OpenOptions;
use std::io::Write as _;
use std::process::Command;

/// Whether whatever can be installed must be there: `scripts/test --require-all`.
#[must_use]
pub fn all_required() -> bool {
    std::env::var_os("SERVOID_REQUIRE_ALL").is_some_and(|value| value == "1")
}

/// Says that the calling test is skipped, or a part of it.
pub fn skipped(why: &str) {
    note("SKIPPED", why);
}

/// A tool that a test runs. Where it is missing the test says so and goes without; where all is required it fails.
#[must_use]
pub fn tool(name: &str) -> Option<Command> {
    let there = Command::new(name).arg("--version").output();
    if there.is_ok_and(|output| output.status.success()) {
        return Some(Command::new(name));
    }
    assert!(!all_required(), "no {name} here, and it is required");
    skipped(&format!("no {name} here"));
    None
}

/// A line with the calling test's name. In one piece, since other tests write, too.
pub(crate) fn note(what: &str, why: &str) {
    let line = format!("{what} {}: {why}\n", test());
    // Not by `eprint`, which the runner would catch.
    let _ = std::io::stderr().write_all(line.as_bytes());
    if let Some(path) = std::env::var_os("SERVOID_NOTES") {
        let file = OpenOptions::new().append(true).create(true).open(path);
        file.and_then(|mut file| file.write_all(line.as_bytes()))
            .expect("SERVOID_NOTES can be written");
    }
}

/// The runner names its threads for the tests; alone, a test runs in the main thread, and its name was asked for.
fn test() -> String {
    match std::thread::current().name() {
        Some(name) if name != "main" => name.to_owned(),
        _ => std::env::args()
            .skip(1)
            .find(|argument| !argument.starts_with('-'))
            .unwrap_or_else(|| "a test".to_owned()),
    }
}
