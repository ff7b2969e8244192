//! Streams that close, fill up or stand in for files.

use std::process::Stdio;

use crate::desk::{Desk, Outcome};

const TALKATIVE: &[&str] = &[
    "fit rec.csv",
    "fit rec.csv --json -",
    "compare rec.csv --seeds 1 --budget 5",
    "simulate --list",
    "completions bash",
    "completions zsh",
    "completions fish",
    "--help",
    "fit --help",
];

/// As `servoid … | head` does once it has seen enough: the reader is gone before the first byte.
#[test]
fn a_reader_that_leaves_is_no_error() {
    let desk = Desk::with_recording();
    for line in TALKATIVE {
        let mut child = desk.spawn(line);
        drop(child.stdout.take());
        let outcome = Outcome::new(line, child.wait_with_output().expect("servoid ends"));
        assert_eq!(outcome.code, Some(0), "{outcome}");
        assert_eq!(outcome.stderr, "", "{outcome}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_stdout_is_an_error() {
    let desk = Desk::with_recording();
    for line in TALKATIVE.iter().filter(|line| !line.contains("--help")) {
        let full = std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("/dev/full");
        let output = desk
            .command(line)
            .stdout(full)
            .stderr(Stdio::piped())
            .output()
            .expect("servoid");
        Outcome::new(line, output).is_refusal(1, &["stdout"]);
    }
}

#[cfg(unix)]
#[test]
fn a_recording_comes_and_goes_through_devices() {
    let desk = Desk::with_recording();
    let to_stdout = desk
        .done("simulate --seconds 1 --no-motor --quiet --out /dev/stdout")
        .stdout;
    assert!(
        to_stdout.contains("t_s,voltage_v,angle_counts\n"),
        "{to_stdout}"
    );
    let mut command = desk.command("fit /dev/stdin --counts-per-rev 2000");
    command.stdin(std::fs::File::open(desk.path("rec.csv")).expect("the recording"));
    let outcome = Outcome::new("fit /dev/stdin", command.output().expect("servoid"));
    assert_eq!(outcome.code, Some(0), "{outcome}");
    desk.done("fit rec.csv --json /dev/null --plot /dev/null");
}
