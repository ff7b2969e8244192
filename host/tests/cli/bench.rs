//! `bench`: what it refuses before a page is opened. The page itself is tried in a browser.

use crate::desk::Desk;

#[test]
fn no_file_that_was_there_is_replaced_by_a_bench_with_a_recording() {
    let desk = Desk::with_recording();
    desk.done("simulate --seconds 2 --seed 2 --out other.csv");
    desk.write("kept.json", "{\"schema\": \"servoid.session/1\"}\n");
    desk.write("damaged.json", "{\"schema\": \"servoid.session/1\", \"mod");
    desk.write("notes.txt", "mine");
    desk.write("empty.json", "");
    let bench = |flags: &str| format!("bench {flags} --no-open");
    for file in ["kept.json", "damaged.json", "notes.txt", "empty.json"] {
        let before = desk.read(file);
        let says = ["--session", file, "leave the recording away"];
        desk.refused(&bench(&format!("rec.csv --session {file}")), 2, &says);
        assert_eq!(desk.read(file), before, "{file}");
    }
    for (flags, says) in [
        ("rec.csv --session rec.csv", "also the recording"),
        (
            "rec.csv --validate other.csv --session other.csv",
            "also the --validate recording",
        ),
        ("rec.csv --session .", "folder"),
        ("rec.csv --session no/where.json", "folder"),
        ("--validate other.csv", "name that one first"),
        ("kept.json --validate other.csv", "leave --validate away"),
        ("rec.csv kept.json", "is a session"),
        (
            "rec.csv other.csv --session other.csv",
            "also the recording",
        ),
    ] {
        desk.refused(&bench(flags), 2, &[says]);
    }
}

#[test]
fn a_session_of_another_version_is_refused_as_such_and_kept_as_it_is() {
    let desk = Desk::new();
    for (content, says) in [
        (
            "{\"schema\": \"servoid.session/9\", \"fitted\": 7}",
            "servoid.session/9",
        ),
        (
            "{\"schema\": \"servoid.session/1\", \"models\": 7}",
            "invalid type",
        ),
        ("{\"schema\": \"servoid.session/1\", \"mod", "EOF"),
    ] {
        desk.write("session.json", content);
        for line in [
            "bench session.json --no-open",
            "bench --session session.json --no-open",
            "bench session.json --session session.json --no-open",
        ] {
            desk.refused(line, 1, &["session.json", says]);
            assert_eq!(desk.read("session.json"), content);
        }
    }
}
