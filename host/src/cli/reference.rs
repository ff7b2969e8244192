//! The reference page of the command line in the book, generated from the program: it is what the help says, or this law fails.
//!
//! `UPDATE_REFERENCE=1 cargo test -p host --lib reference` writes it anew.

use super::Cli;
use clap::{Command, CommandFactory};
use std::fs;
use std::path::Path;

/// Columns of the help texts.
const WIDTH: usize = 100;

/// Every verb's `--help`, as one page.
fn command_line() -> String {
    let mut page =
        "# Command line\n\nThis page is generated from the program's `--help`.\n".to_owned();
    let mut command = Cli::command().term_width(WIDTH);
    command.build();
    append(&mut page, &mut command, "servoid");
    page
}

fn append(page: &mut String, command: &mut Command, name: &str) {
    let help = command.render_long_help().to_string();
    let lines: Vec<&str> = help.lines().map(str::trim_end).collect();
    *page += &format!("\n## `{name}`\n\n```text\n{}\n```\n", lines.join("\n"));
    for verb in command
        .get_subcommands_mut()
        .filter(|verb| verb.get_name() != "help")
    {
        let name = format!("{name} {}", verb.get_name());
        append(page, verb, &name);
    }
}

#[test]
fn the_reference_page_says_what_the_program_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/book/src/reference/cli.md");
    let page = command_line();
    if std::env::var_os("UPDATE_REFERENCE").is_some() {
        fs::write(&path, &page).expect("the page can be written");
    }
    let found = fs::read_to_string(&path).expect("the page is there");
    assert!(
        found == page,
        "cli.md is stale: write it anew with UPDATE_REFERENCE=1 cargo test -p host --lib reference"
    );
}
