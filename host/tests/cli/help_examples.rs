//! What the help shows is what a newcomer types first: every command of it runs as it is printed, one after the
//! other in one folder, and fits a terminal. Those of `servoid device` need a device or its image.

use crate::desk::Desk;
use crate::width::fits_a_terminal;

/// The commands that a help text shows, without the program's name.
fn examples(desk: &Desk, help: &str) -> Vec<String> {
    let text = desk.done(help).stdout;
    let commands = text
        .lines()
        .filter_map(|line| line.strip_prefix("  servoid "));
    commands.map(str::to_owned).collect()
}

fn run(help: &str) {
    let desk = Desk::new();
    let examples = examples(&desk, help);
    assert!(!examples.is_empty(), "{help} shows no example");
    for example in &examples {
        let printed = desk.done(example).stdout;
        // What `export` prints is for a program.
        if !example.starts_with("export ") {
            fits_a_terminal(example, &printed);
        }
    }
}

#[test]
fn the_examples_of_the_first_help_run_as_printed() {
    run("--help");
}

#[test]
fn the_examples_of_diagnose_run_as_printed() {
    run("diagnose --help");
}

#[test]
fn the_examples_of_export_run_as_printed() {
    run("export --help");
}
