//! Laws over all formats and results: every effect, with much and with little known, on both sides of a gear.

mod compile;
mod makers;
mod numbers;

use super::samples::{DIGITS, KNOWN, Known, linear, result, subject};
use super::{ExportError, FORMATS, Format, Options, Side, Subject, Written};
use crate::schema::device::Grade;
use crate::schema::{Graded, Identified};
use servoid_io::input::MotorFile;
use servoid_plant as bench;
use shared::effects::Kind;
use std::fs;
use std::path::Path;

const OUTPUT: Side = Side::Output { ratio: 30.0 };

/// Every result of a list: the linear motors of the bench and each effect, all that is known and little.
fn results() -> Vec<(String, Identified)> {
    let mut results = Vec::new();
    for known in KNOWN {
        for name in bench::PRESETS {
            let motor = bench::Machine::preset(name).expect("a preset");
            results.push((format!("{name}, {known:?}"), linear(&motor, known)));
        }
        let motor = bench::Machine::gearmotor();
        for &kind in Kind::ALL {
            let name = format!("{}, {known:?}", kind.name());
            results.push((name, result(&motor, &[kind], known)));
        }
        let law = result(&motor, &[stated()], known);
        results.push((format!("a law, {known:?}"), law));
        let twice = [Kind::Cogging, Kind::Coulomb, Kind::Cogging];
        results.push((format!("twice, {known:?}"), result(&motor, &twice, known)));
    }
    results
}

/// A law with a state and functions.
fn stated() -> Kind {
    let text = "swing: z' = (w - abs(w)*z)/h; torque = -c*z*tanh(w/v)*exp(-abs(w)/v) + c*cos(theta)*max(i/e, 0)^p; \
                c = 0.1 in [0, 1] V; h = 0.1 in [0.01, 1] rad; v = 20 rad/s; e = 2 V; p = 1.5 in [0.5, 3]";
    servoid_formula::define(text).expect("a law")
}

/// A law with two states that depends on the command and the temperature, too.
fn of_everything() -> Kind {
    let text = "sticky: x' = (w - y)*a; y' = k*x; current = -c*x*(1 - b*(temperature - t0)) + d*v*sgn(w); \
                c = 0.2 in [0, 1] V; a = 1 in [0, 2] 1/rad; k = 90 in [1, 1000] rad/s^2; b = 0.004 in [0, 0.1] 1/degC; t0 = 25 degC; \
                d = 0.1 in [0, 1]; y in [-100, 100] rad/s";
    servoid_formula::define(text).expect("a law")
}

fn write(format: &Format, subject: &Subject) -> Result<Written, ExportError> {
    (format.write)(subject, &Options::default())
}

/// Every text that can be written, with its format and what it was made from.
fn texts() -> Vec<(&'static str, String, Subject, Written)> {
    let mut texts = Vec::new();
    for (name, result) in results() {
        for side in [Side::Motor, OUTPUT] {
            let subject = subject(&result, side);
            for format in FORMATS {
                let case = format!("{}, {name}, {}", format.name, side.name());
                match write(format, &subject) {
                    Ok(written) => texts.push((format.name, case, subject.clone(), written)),
                    Err(error) => {
                        let error = error.to_string();
                        let remedy = ["fit again", "record", "--", "export to"];
                        assert!(
                            remedy.iter().any(|word| error.contains(word)),
                            "{case}: {error}"
                        );
                    }
                }
            }
        }
    }
    texts
}

#[test]
fn what_all_is_known_of_goes_into_every_format_and_a_current_loop_s_into_those_that_need_no_volts()
{
    let motor = bench::Machine::gearmotor();
    for &kind in Kind::ALL {
        for format in FORMATS {
            let all = subject(&result(&motor, &[kind], Known::All), Side::Motor);
            write(format, &all).unwrap_or_else(|e| panic!("{}, {}: {e}", format.name, kind.name()));
        }
    }
    for format in FORMATS {
        let current = subject(&linear(&motor, Known::Current), Side::Motor);
        let takes = [
            "toml", "json", "csv", "c", "rust", "python", "modelica", "gains",
        ];
        let refused = !takes.contains(&format.name) && format.name != "ros2-control";
        assert_eq!(write(format, &current).is_err(), refused, "{}", format.name);
        let nothing = subject(&linear(&motor, Known::Nothing), Side::Motor);
        let tables = ["toml", "json", "csv"].contains(&format.name);
        assert_eq!(write(format, &nothing).is_ok(), tables, "{}", format.name);
    }
}

#[test]
fn no_text_has_a_number_that_is_none_or_that_is_not_determined() {
    for (_, case, _, written) in texts() {
        let text = written.text.to_lowercase();
        let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
        for word in words {
            let none = ["nan", "inf", "nanf", "inff"].contains(&word);
            assert!(!none, "{case}: {text}");
        }
        assert!(!text.contains(DIGITS), "{case}: {text}");
    }
}

#[test]
fn numbers_that_a_device_did_not_verify_are_marked_in_every_format() {
    let motor = bench::Machine::gearmotor();
    let result = Identified {
        grade: Some(Graded {
            grade: Grade::No,
            reason: Some("the fit is not verified */ -->".to_owned()),
        }),
        ..result(&motor, &[Kind::Coulomb], Known::All)
    };
    for format in FORMATS {
        let written = write(format, &subject(&result, Side::Motor)).expect("a text");
        let marks = |text: &str| text.contains("NOT VERIFIED");
        assert!(marks(&written.text), "{}: {}", format.name, written.text);
        assert!(
            written.lines().iter().any(|line| marks(line)),
            "{}",
            format.name
        );
    }
}

#[test]
fn every_effect_goes_somewhere_or_is_said_to_be_left_out() {
    for (_, case, subject, written) in texts() {
        for term in &subject.terms {
            let name = term.kind.name();
            let mapped = written.mapping.iter().any(|m| m.from.contains(name));
            let left = written.cannot_carry.iter().any(|l| l.what.contains(name));
            assert!(mapped || left, "{case}: {name} is nowhere: {written:#?}");
        }
        for mapped in &written.mapping {
            assert_eq!(mapped.side, subject.side.name(), "{case}");
            assert!(
                !mapped.unit.is_empty() && !mapped.to.is_empty(),
                "{case}: {mapped:?}"
            );
        }
    }
}

#[test]
fn every_text_is_of_its_language() {
    for (format, case, subject, written) in texts() {
        let text = &written.text;
        let wrong = |error: String| -> ! { panic!("{case}: {error}\n{text}") };
        match format {
            "toml" => {
                let table: toml::Table = text.parse().unwrap_or_else(|e| wrong(format!("{e}")));
                let rows = table["parameters"].as_array().expect("a list");
                assert_eq!(rows.len(), subject.values.len(), "{case}");
                for row in rows {
                    let determined = row["identifiable"].as_bool().expect("a flag");
                    assert_eq!(determined, row.get("value").is_some(), "{case}: {row}");
                }
                if let Some(known) = table.get("known") {
                    let known = format!("[known]\n{known}");
                    let section = text.split_once("[known]").expect("a section").1;
                    let section = section.split_once("\n\n").map_or(section, |parts| parts.0);
                    let motor = MotorFile::parse(&format!("[known]{section}\n"), "motor.toml");
                    let motor = motor.unwrap_or_else(|e| wrong(format!("{e}: {known}")));
                    let given = motor.known.facts().into_iter().filter(|f| f.1.is_some());
                    assert_eq!(given.count(), 6, "{case}");
                }
            }
            "gains" => {
                let table: toml::Table = text.parse().unwrap_or_else(|e| wrong(format!("{e}")));
                let speed = table["speed_loop"].as_table().expect("a section");
                assert!(
                    speed["phase_margin_deg"].as_float().expect("a number") >= 30.0,
                    "{case}"
                );
            }
            "json" => {
                let value: serde_json::Value =
                    serde_json::from_str(text).unwrap_or_else(|e| wrong(e.to_string()));
                let rows = value["parameters"].as_array().expect("a list");
                assert_eq!(rows.len(), subject.values.len(), "{case}");
            }
            "csv" => {
                let reader = csv::ReaderBuilder::new()
                    .comment(Some(b'#'))
                    .from_reader(text.as_bytes());
                let rows: Result<Vec<_>, _> = reader.into_records().collect();
                let rows = rows.unwrap_or_else(|e| wrong(e.to_string()));
                assert_eq!(rows.len(), subject.values.len(), "{case}");
                assert!(rows.iter().all(|row| row.len() == 6), "{case}");
            }
            "mujoco" | "urdf" => {
                let document =
                    roxmltree::Document::parse(text).unwrap_or_else(|e| wrong(e.to_string()));
                let numbers = document.descendants().flat_map(|node| node.attributes());
                for attribute in numbers.filter(|a| a.name() == "damping" || a.name() == "armature")
                {
                    let number: f64 = attribute.value().parse().expect("a number");
                    assert!(number >= 0.0, "{case}: {attribute:?}");
                }
            }
            "modelica" | "wpilib" => {
                let opened = text.matches("record Motor").count() + text.matches("{\n").count();
                assert_eq!(opened, 1, "{case}: {text}");
                for line in text
                    .lines()
                    .filter(|line| line.starts_with("  p") && line.contains('='))
                {
                    assert!(line.trim_end().ends_with(';'), "{case}: {line}");
                    // In Modelica a unit stands behind the name, and not behind the type.
                    let kind = line.split(' ').find(|word| word.starts_with("Real"));
                    assert!(kind.is_none_or(|kind| kind == "Real"), "{case}: {line}");
                }
            }
            "c" | "rust" | "python" => {}
            "bam" | "mjlab" | "simscape" | "ros2-control" | "odrive" | "vesc" | "moteus" => {
                makers::is_of_its_language(format, text).unwrap_or_else(|error| wrong(error));
            }
            other => wrong(format!("a format without a test: {other}")),
        }
    }
}

#[test]
fn no_file_of_the_repository_lists_other_formats_than_there_are() {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book/src");
    let json = fs::read_to_string(book.join("reference/json.md")).expect("the documentation");
    for format in FORMATS {
        assert!(
            json.contains(&format!("`{}`", format.name)),
            "{}",
            format.name
        );
    }
}
