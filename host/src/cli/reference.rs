//! The reference pages of the book, generated from the program: they are what it says, or this law fails.
//!
//! `UPDATE_REFERENCE=1 cargo test -p host --lib reference` writes them anew.

use super::Cli;
use clap::{Command, CommandFactory};
use shared::effects::{Kind, Place};
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

/// The catalogue of effects, as one page.
fn effects() -> String {
    let mut page = "# Catalogue of effects\n\n\
        This page is generated from the `DESCRIPTION` of each effect in `shared/src/effects/`, in the order of their numbers on \
        the wire.\nTorques are in V, referred to the winding. Viscous friction is part of the linear motor.\n\n\
        | name | acts on | equation | sign in the residual | exposed by | look-alikes |\n|---|---|---|---|---|---|\n"
        .to_owned();
    let cell = |text: &str| text.replace('|', "\\|");
    for description in Kind::ALL.iter().map(|kind| kind.description()) {
        let place = match description.place {
            Place::Drive => "drive",
            Place::Winding => "winding",
            Place::Torque => "torque",
            Place::Friction => "friction",
            Place::Load => "load",
            Place::Sensed => "sensed",
        };
        let alike: Vec<String> = description
            .look_alikes
            .iter()
            .map(|name| format!("`{name}`"))
            .collect();
        page += &format!(
            "| `{}`: {} | {place} | `{}` | {} | {} | {} |\n",
            description.name,
            cell(description.title),
            cell(description.equation),
            cell(description.signature),
            cell(description.exposed_by),
            alike.join(", ")
        );
    }
    page += "\n## Sources\n\n| name | source |\n|---|---|\n";
    for description in Kind::ALL.iter().map(|kind| kind.description()) {
        page += &format!(
            "| `{}` | {} |\n",
            description.name,
            cell(description.source)
        );
    }
    page
}

#[test]
fn the_reference_pages_say_what_the_program_says() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/book/src/reference");
    for (name, page) in [("cli.md", command_line()), ("effects.md", effects())] {
        let path = folder.join(name);
        if std::env::var_os("UPDATE_REFERENCE").is_some() {
            fs::write(&path, &page).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        let found = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(
            found == page,
            "{name} is stale: write it anew with UPDATE_REFERENCE=1 cargo test -p host --lib reference"
        );
    }
}
