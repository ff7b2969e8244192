//! Laws over all formats and results: every effect, with much and with little known, on both sides of a gear.

use super::gains::feed_forward::FeedForward;
use super::samples::{DIGITS, KNOWN, Known, linear, result, subject};
use super::{ExportError, FORMATS, Format, Options, Side, Subject, Written};
use crate::bench;
use crate::input::MotorFile;
use crate::kept::KeptResult;
use shared::effects::Kind;
use shared::model::{Model, Plan, State};
use shared::units::PerUnit;
use std::fs;
use std::path::Path;
use std::process::Command;

const OUTPUT: Side = Side::Output { ratio: 30.0 };

/// Every result of a list: the linear motors of the bench and each effect, all that is known and little.
fn results() -> Vec<(String, KeptResult)> {
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
        let twice = [Kind::Cogging, Kind::Coulomb, Kind::Cogging];
        results.push((format!("twice, {known:?}"), result(&motor, &twice, known)));
    }
    results
}

fn write(format: &Format, subject: &Subject) -> Result<Written, ExportError> {
    (format.write)(subject, &Options::default())
}

/// Every text that can be written, with its format and what it was made from.
fn texts() -> Vec<(&'static str, String, Subject, Written)> {
    let mut texts = Vec::new();
    for (name, kept) in results() {
        for side in [Side::Motor, OUTPUT] {
            let subject = subject(&kept, side);
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
        let refused = ["mujoco", "urdf", "wpilib"].contains(&format.name);
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
                }
            }
            "c" | "rust" => {}
            other => wrong(format!("a format without a test: {other}")),
        }
    }
}

/// The tool, if it is there; said aloud if it is not.
fn tool(name: &str) -> Option<Command> {
    if Command::new(name)
        .arg("--version")
        .output()
        .is_ok_and(|o| o.status.success())
    {
        return Some(Command::new(name));
    }
    eprintln!("skipped: no {name} here");
    None
}

fn passes(mut command: Command, case: &str, text: &str) {
    let done = command.output().expect("it starts");
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(
        done.status.success() && said.is_empty(),
        "{case}: {said}\n{text}"
    );
}

#[test]
fn headers_and_modules_compile_without_a_warning() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let (mut c, mut rust) = (String::new(), String::new());
    for (k, (format, _, _, written)) in texts().into_iter().enumerate() {
        // All in one, since a compiler takes longer to start than to read them.
        match format {
            "c" => {
                fs::write(path(&format!("m{k}.h")), &written.text).expect("a file");
                c += &format!(
                    "#include \"m{k}.h\"\nstatic const float s{k}[] = {{ SERVOID_STEP_W_BY_V, SERVOID_SAMPLE }};\n"
                );
                c += &format!(
                    "float f{k}(void);\nfloat f{k}(void) {{ return s{k}[0] + s{k}[1]; }}\n#undef SERVOID_MOTOR_H\n"
                );
                for line in written
                    .text
                    .lines()
                    .filter(|line| line.starts_with("#define SERVOID_"))
                {
                    let name = line.split(' ').nth(1).expect("a name");
                    c += &format!("#undef {name}\n");
                }
            }
            "rust" => {
                rust += &format!(
                    "/// Of one result.\npub mod m{k} {{\n{}\n}}\n",
                    written.text
                )
            }
            _ => {}
        }
    }
    if let Some(mut gcc) = tool("gcc") {
        fs::write(path("all.c"), &c).expect("a file");
        gcc.args([
            "-fsyntax-only",
            "-std=c99",
            "-Wall",
            "-Wextra",
            "-Werror",
            "-pedantic",
        ]);
        gcc.arg(path("all.c"));
        passes(gcc, "c", "");
    }
    if let Some(mut rustc) = tool("rustc") {
        let text =
            format!("//! All of them.\n#![no_std]\n#![deny(warnings, missing_docs)]\n{rust}");
        fs::write(path("all.rs"), text).expect("a file");
        rustc.args([
            "--edition",
            "2024",
            "--crate-type",
            "lib",
            "--emit",
            "metadata",
            "-o",
        ]);
        rustc.arg(path("all.rmeta")).arg(path("all.rs"));
        passes(rustc, "rust", "");
    }
}

/// Steps of 1 ms.
const STEPS: usize = 400;

fn command(k: usize) -> f64 {
    4.0 * (k as f64 * 0.02).sin() + 2.0
}

/// Speed after each step of the model itself, rad/s.
fn speeds(subject: &Subject) -> Vec<f64> {
    let units = PerUnit::new(12.0, 700.0, 1e-3, 2000.0).expect("units");
    let mut plan = Plan::linear(subject.machine, units);
    for term in &subject.terms {
        plan.effects
            .push(term.kind, &term.values)
            .expect("an effect");
    }
    let model: Model<f64> = Model::new(&plan).expect("a model");
    let mut state = State::default();
    let step = |k: usize| {
        model.step(&mut state, command(k) / 12.0, false);
        state.motion.speed * 700.0
    };
    (0..STEPS).map(step).collect()
}

#[test]
fn a_program_with_the_header_follows_the_model() {
    let Some(mut gcc) = tool("gcc") else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let subject = subject(
        &linear(&bench::Machine::gearmotor(), Known::All),
        Side::Motor,
    );
    let written = write(Format::by_name("c").expect("a format"), &subject).expect("a header");
    let path = |name: &str| folder.path().join(name);
    fs::write(path("motor.h"), &written.text).expect("a header");
    let volts: Vec<String> = (0..STEPS)
        .map(|k| format!("{:?}f", command(k) as f32))
        .collect();
    let program = format!(
        "#include <stdio.h>\n#include \"motor.h\"\nint main(void) {{ float c = 0, w = 0; static const float v[] = {{ {} }};\n\
         for (unsigned k = 0; k < {STEPS}; k++) {{ float dc = SERVOID_STEP_C_BY_C*c + SERVOID_STEP_C_BY_W*w + SERVOID_STEP_C_BY_V*v[k];\n\
         w += SERVOID_STEP_W_BY_C*c + SERVOID_STEP_W_BY_W*w + SERVOID_STEP_W_BY_V*v[k]; c += dc; printf(\"%g\\n\", (double)w); }} return 0; }}\n",
        volts.join(", ")
    );
    fs::write(path("main.c"), program).expect("a program");
    gcc.args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-o"]);
    gcc.arg(path("main")).arg(path("main.c"));
    passes(gcc, "c", &written.text);
    let out = Command::new(path("main")).output().expect("it runs").stdout;
    let out = String::from_utf8(out).expect("text");
    let ran: Vec<f64> = out
        .lines()
        .map(|line| line.parse().expect("a number"))
        .collect();
    let truth = speeds(&subject);
    assert_eq!(ran.len(), truth.len());
    for (k, (ran, truth)) in ran.iter().zip(&truth).enumerate() {
        assert!((ran - truth).abs() < 2e-3, "step {k}: {ran}, not {truth}");
    }
}

#[test]
fn feed_forward_asks_for_the_voltage_that_moved_the_motor() {
    // Slow motors whose winding is fast: what a2 adds with the jerk is small.
    for (name, kinds) in [
        ("gearmotor", vec![Kind::Coulomb]),
        ("coreless_24v", vec![Kind::Coulomb, Kind::LoadTorque]),
        ("gearmotor", vec![Kind::LoadTorque, Kind::OffsetVoltage]),
        ("gearmotor", vec![Kind::DeadZone, Kind::Coulomb]),
        ("coreless_24v", vec![]),
    ] {
        let motor = bench::Machine::preset(name).expect("a preset");
        let subject = subject(&result(&motor, &kinds, Known::All), Side::Motor);
        let feed = FeedForward::of(&subject, &mut Written::new(&subject));
        let speeds = speeds(&subject);
        let mut seen = 0;
        for k in 10..STEPS - 1 {
            let (before, speed, after) = (speeds[k - 1], speeds[k], speeds[k + 1]);
            // Where it moves on: stops and reversals are friction's own affair.
            if speeds[k - 9..k + 2]
                .iter()
                .any(|w| w * speed <= 0.0 || w.abs() < 1.0)
            {
                continue;
            }
            // A dead zone has the sign of the command, and kS that of the speed: driving they are one.
            let drives = [k, k + 1].map(command);
            if kinds.contains(&Kind::DeadZone) && drives.iter().any(|u| u * speed <= speed.abs()) {
                continue;
            }
            let (k_s, k_g) = (feed.k_s.unwrap_or(0.0), feed.k_g.unwrap_or(0.0));
            let asked =
                k_s * speed.signum() + k_g + feed.k_v * speed + feed.k_a * (after - before) / 2e-3;
            // The speed at a reading lies between the command before and the one after.
            let given = 0.5 * (command(k) + command(k + 1));
            assert!(
                (asked - given).abs() < 0.06,
                "{name}, {kinds:?}, {k}: {asked} V, not {given} V"
            );
            seen += 1;
        }
        assert!(seen > 50, "{name}: {seen}");
    }
}

#[test]
fn the_output_s_numbers_are_those_of_the_motor_behind_its_gear() {
    let motor = bench::Machine::gearmotor();
    let kept = result(&motor, &[Kind::Coulomb], Known::All);
    let (here, there) = (subject(&kept, Side::Motor), subject(&kept, OUTPUT));
    let factor =
        |name: &str| there.determined(name).expect(name) / here.determined(name).expect(name);
    for (name, expected) in [
        ("gain", 1.0 / 30.0),
        ("a1", 1.0),
        ("inertia", 900.0),
        ("viscous", 900.0),
        ("kt", 30.0),
        ("resistance", 1.0),
    ] {
        assert!((factor(name) / expected - 1.0).abs() < 1e-12, "{name}");
    }
    // The same voltage gives the torque times 30.
    let torques =
        [&here, &there].map(|s| s.terms[0].values[0] / s.volts_per_torque().expect("R/Kt"));
    assert!((torques[1] / torques[0] / 30.0 - 1.0).abs() < 1e-9);
    // With a ratio of one, both sides are one.
    let one = subject(&kept, Side::Output { ratio: 1.0 });
    assert_eq!(one.values, here.values);
}

/// An attribute of an element of a MuJoCo model.
fn attribute(text: &str, element: &str, name: &str) -> Option<f64> {
    let document = roxmltree::Document::parse(text).expect("XML");
    let node = document.descendants().find(|n| n.has_tag_name(element))?;
    let value = node.attribute(name)?.split(' ').next()?;
    Some(value.parse().expect("a number"))
}

#[test]
fn a_mujoco_motor_has_the_torque_and_the_friction_of_ours() {
    let format = Format::by_name("mujoco").expect("a format");
    for name in bench::PRESETS {
        let motor = bench::Machine {
            kt_n_m_a: 0.8 * bench::Machine::preset(name).expect("a preset").kt_n_m_a,
            ..bench::Machine::preset(name).expect("a preset")
        };
        for side in [Side::Motor, OUTPUT] {
            let turns = if side == Side::Motor { 1.0 } else { 30.0 };
            let both = [Kind::Lugre, Kind::Coulomb];
            let subject = subject(&result(&motor, &both, Known::All), side);
            let text = write(format, &subject).expect("a model").text;
            let of_motor = |name| attribute(&text, "dcmotor", name).expect(name);
            let of_joint = |name| attribute(&text, "joint", name).expect(name);
            let (resistance, k) = (of_motor("resistance"), of_motor("motorconst"));
            // One volt at rest, and one radian a second without a volt.
            let torque = motor.kt_n_m_a / motor.resistance_ohm * turns;
            assert!((k / resistance / torque - 1.0).abs() < 1e-9, "{name}");
            let brake = torque * motor.kb_v_s_rad * turns;
            assert!((k * k / resistance / brake - 1.0).abs() < 1e-9, "{name}");
            let inertia = motor.inertia_kg_m2 * turns * turns;
            assert!(
                (of_joint("armature") / inertia - 1.0).abs() < 1e-9,
                "{name}"
            );
            let viscous = motor.viscous_n_m_s * turns * turns;
            assert!((of_joint("damping") / viscous - 1.0).abs() < 1e-9, "{name}");
            // The bristles' friction stands once.
            let coulomb = subject.terms[1].values[0] * torque;
            assert!(
                (of_joint("frictionloss") / coulomb - 1.0).abs() < 1e-9,
                "{name}"
            );
            assert!(of_motor("lugre") > 0.0, "{name}");
        }
    }
}

#[test]
fn no_file_of_the_repository_lists_other_formats_than_there_are() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let json = fs::read_to_string(root.join("docs/json.md")).expect("the documentation");
    for format in FORMATS {
        assert!(
            json.contains(&format!("`{}`", format.name)),
            "{}",
            format.name
        );
    }
}
