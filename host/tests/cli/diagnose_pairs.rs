//! Two recordings that do not belong together, or one that cannot be used: each is reported by name.

use crate::desk::Desk;
use crate::diagnose::is_diagnosis;
use crate::width::unfolded;
use serde_json::Value;

/// A desk with `rec.csv` and `other.csv` of one motor that hides nothing.
fn pair() -> Desk {
    let desk = Desk::new();
    desk.done("simulate --seconds 3 --out rec.csv");
    desk.done("simulate --seconds 3 --seed 2 --out other.csv");
    desk
}

/// Rewrites the cells of a recording, row by row.
pub fn rewritten(desk: &Desk, from: &str, to: &str, change: impl Fn(usize, &mut Vec<String>)) {
    let text = desk.read(from);
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let mut out = String::new();
    for (row, line) in lines.enumerate() {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if row > 0 {
            change(row - 1, &mut cells);
        }
        out += &cells.join(",");
        out.push('\n');
    }
    desk.write(to, out);
}

pub fn number(cell: &str) -> f64 {
    cell.parse().expect("a number")
}

/// The diagnosis of `rec.csv` against another recording, and its remarks in one text.
fn remarks(desk: &Desk, other: &str) -> (Value, String) {
    let diagnosis = desk.json(&format!("diagnose rec.csv --validate {other}"));
    is_diagnosis(&diagnosis);
    let list = diagnosis["remarks"].as_array().expect("a list");
    let text: Vec<&str> = list.iter().filter_map(Value::as_str).collect();
    let text = text.join("\n");
    (diagnosis, text)
}

#[test]
fn another_motor_is_told_by_its_constants() {
    let desk = pair();
    desk.done("simulate --seconds 3 --machine coreless_24v --no-motor --out stranger.csv");
    let (diagnosis, text) = remarks(&desk, "stranger.csv");
    assert_eq!(diagnosis["verdict"], "unexplained", "{diagnosis:#}");
    for word in ["another motor", "gain", "a1", "instead of"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn another_sample_time_works() {
    let desk = pair();
    desk.done("simulate --seconds 3 --sample 0.002 --seed 3 --out slower.csv");
    let (diagnosis, text) = remarks(&desk, "slower.csv");
    assert_eq!(diagnosis["verdict"], "complete", "{diagnosis:#}");
    assert_eq!(text, "");
}

#[test]
fn less_than_a_second_is_said() {
    let desk = pair();
    desk.done("simulate --seconds 0.6 --excite steps --seed 3 --out short.csv");
    let (_, text) = remarks(&desk, "short.csv");
    assert!(text.contains("short.csv: lasts 0.599 s"), "{text}");
    desk.refused(
        "diagnose short.csv",
        1,
        &["short.csv", "too short to hold a part", "--validate"],
    );
}

#[test]
fn missed_counts_are_seen_in_the_held_out_recording() {
    let desk = pair();
    rewritten(&desk, "other.csv", "missed.csv", |row, cells| {
        let lost = if row > 2000 { 12.0 } else { 0.0 };
        cells[2] = format!("{}", number(&cells[2]) - lost);
    });
    let (diagnosis, text) = remarks(&desk, "missed.csv");
    assert_eq!(diagnosis["verdict"], "unexplained", "{diagnosis:#}");
    for word in [
        "missed.csv: the reading jumps 1 time",
        "-12 counts at 2.00",
        "misses counts",
    ] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn a_stuck_encoder_is_said_of_either_recording() {
    let desk = pair();
    let held = desk
        .read("other.csv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .nth(401)
        .and_then(|line| line.split(',').nth(2).map(str::to_owned))
        .expect("a count");
    rewritten(&desk, "other.csv", "stuck.csv", |row, cells| {
        if (400..2400).contains(&row) {
            cells[2] = held.clone();
        }
    });
    for line in [
        "diagnose rec.csv --validate stuck.csv --budget 1",
        "diagnose stuck.csv --validate rec.csv --budget 1",
        "diagnose stuck.csv --budget 1",
    ] {
        let said = unfolded(&desk.run(line).to_string());
        for word in [
            "stuck.csv: the encoder is stuck from 0.400 to 2.399 s",
            "cut that part out",
        ] {
            assert!(said.contains(word), "{line}: {word}: {said}");
        }
    }
}

#[test]
fn a_command_that_the_log_cuts_off_is_said() {
    let desk = pair();
    rewritten(&desk, "other.csv", "clipped.csv", |_, cells| {
        cells[1] = format!("{}", number(&cells[1]).clamp(-4.0, 4.0));
    });
    let (diagnosis, text) = remarks(&desk, "clipped.csv");
    assert_eq!(diagnosis["verdict"], "unexplained", "{diagnosis:#}");
    assert!(
        text.contains("clipped.csv: the command is cut off at 4.00 V"),
        "{text}"
    );
}

#[test]
fn a_supply_below_the_commands_is_said() {
    let desk = pair();
    let diagnosis = desk.json("diagnose rec.csv --validate other.csv --supply-v 9");
    let text = diagnosis["remarks"].to_string();
    for file in ["rec.csv", "other.csv"] {
        let says = format!("{file}: commands reach 12.00 V and supply_v is 9.00 V");
        assert!(text.contains(&says), "{text}");
    }
}

#[test]
fn a_swapped_sign_is_named_for_either_recording() {
    let desk = pair();
    rewritten(&desk, "other.csv", "swapped.csv", |_, cells| {
        cells[2] = format!("{}", -number(&cells[2]));
    });
    for line in [
        "diagnose rec.csv --validate swapped.csv",
        "diagnose swapped.csv --validate rec.csv",
        "diagnose swapped.csv",
    ] {
        desk.refused(
            line,
            1,
            &["swapped.csv", "sign", "swap the encoder's channels"],
        );
    }
}

#[test]
fn what_is_no_number_or_nothing_is_refused_with_its_place() {
    let desk = pair();
    rewritten(&desk, "other.csv", "text.csv", |row, cells| {
        if row == 100 {
            cells[2] = "12x".to_owned();
        }
    });
    desk.write("empty.csv", "");
    let cases: [(&str, &[&str]); 2] = [
        ("text.csv", &["text.csv:102:3", "angle_counts", "12x"]),
        ("empty.csv", &["empty.csv: is empty"]),
    ];
    for (file, says) in cases {
        for line in [
            format!("diagnose rec.csv --validate {file}"),
            format!("diagnose {file} --validate rec.csv"),
        ] {
            desk.refused(&line, 1, says);
        }
    }
}

#[test]
fn a_cell_that_says_nothing_is_passed_over_with_a_remark() {
    let desk = pair();
    rewritten(&desk, "other.csv", "nan.csv", |row, cells| {
        if row == 100 {
            cells[2] = "NaN".to_owned();
        }
    });
    let said = desk.done("diagnose rec.csv --validate nan.csv").stderr;
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("nan.csv: 1 row has no angle"), "{said}");
}

#[test]
fn the_same_recording_twice_holds_nothing_out() {
    let desk = pair();
    rewritten(&desk, "rec.csv", "copy.csv", |_, _| {});
    for file in ["rec.csv", "./rec.csv", "copy.csv"] {
        let (diagnosis, text) = remarks(&desk, file);
        assert_eq!(diagnosis["held_out"]["kind"], "nothing");
        assert!(text.contains("nothing is held out"), "{text}");
        let shown = desk
            .done(&format!("diagnose rec.csv --validate {file}"))
            .stdout;
        assert!(shown.contains("nothing is held out"), "{shown}");
    }
}

#[test]
fn results_never_replace_what_is_read() {
    let desk = pair();
    for (file, what) in [
        ("rec.csv", "the recording"),
        ("other.csv", "the --validate recording"),
        ("motor.toml", "the motor file"),
    ] {
        let line = format!("diagnose rec.csv --validate other.csv --json {file}");
        desk.refused(&line, 2, &["--json", what]);
    }
}
