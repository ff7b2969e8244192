//! The page of the book about formats names what is here, and nothing else.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn here() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests")
}

/// What the page has in code marks and may be a file: of a folder as a whole, with `…` for its files.
fn named() -> BTreeSet<String> {
    let page = here().join("../../../docs/book/src/reference/log-formats.md");
    let page = std::fs::read_to_string(page).unwrap();
    let spans = page.split('`').skip(1).step_by(2);
    let is_file = |span: &&str| {
        span.contains('/')
            || Path::new(span)
                .extension()
                .is_some_and(|end| end == "rs" || end == "py")
    };
    spans.filter(is_file).map(str::to_owned).collect()
}

/// Files below a folder, from there on.
fn files(folder: &Path, within: &str, out: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{within}{}", entry.file_name().to_str().unwrap());
        if entry.path().is_dir() {
            files(&entry.path(), &format!("{name}/"), out);
        } else {
            out.push(name);
        }
    }
}

#[test]
fn every_fixture_is_named_with_the_library_that_wrote_it() {
    let named = named();
    let mut found = Vec::new();
    files(&here().join("fixtures"), "", &mut found);
    let is_told = |name: &String| {
        let folders = name.match_indices('/').map(|(at, _)| &name[..at]);
        named.contains(name)
            || folders
                .into_iter()
                .any(|folder| named.contains(&format!("{folder}/…")))
    };
    let untold: Vec<&String> = found
        .iter()
        .filter(|name| name.contains('/') && !name.ends_with("/expected.json"))
        .filter(|name| !is_told(name))
        .collect();
    assert!(untold.is_empty(), "not on the page: {untold:?}");
}

#[test]
fn every_test_and_script_is_named() {
    let named = named();
    let entries = std::fs::read_dir(here())
        .unwrap()
        .map(|entry| entry.unwrap().file_name());
    for name in entries.map(|name| name.into_string().unwrap()) {
        // The module of the scripts, and this law.
        let is_own = ["expected.py", "page.rs"].contains(&name.as_str());
        let is_file = name.ends_with(".rs") || name.ends_with(".py");
        assert!(
            !is_file || is_own || named.contains(&name),
            "{name} is not on the page"
        );
    }
}

#[test]
fn every_file_that_is_named_is_here() {
    for name in named() {
        let name = name.trim_end_matches("/…");
        let places = ["", "fixtures", "../../io/tests", "../../.."]
            .map(|place| here().join(place).join(name));
        assert!(
            places.iter().any(|place| place.exists()),
            "there is no {name}"
        );
    }
}
