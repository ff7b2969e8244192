//! Formats of simulators and drives: every number that is mapped stands in the text under its name, and means there what its maker says.

use super::super::samples::{Known, linear, result, subject};
use super::super::{Format, Options, Side, Subject, Winding, Written};
use super::{OUTPUT, texts, write};
use servoid_plant as bench;
use shared::effects::Kind;
use std::f64::consts::TAU;

/// Formats whose texts are a name and a number a line.
const LINES: [&str; 7] = [
    "bam",
    "mjlab",
    "simscape",
    "ros2-control",
    "odrive",
    "vesc",
    "moteus",
];

/// The number behind a name: what follows it on its line, without what stands between and behind.
fn number(text: &str, name: &str) -> Option<f64> {
    let ends = |rest: &str| !rest.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
    let found = text.lines().find_map(|line| {
        let line = line.trim_start();
        let comment = ["#", "%", ";"].iter().any(|mark| line.starts_with(mark));
        let (before, rest) = line.split_once(name).filter(|_| !comment)?;
        let begins = !before.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_');
        (begins && ends(rest)).then_some(rest)
    })?;
    let digits = found.trim_start_matches([' ', '=', ':', '"']);
    let end = digits.find(|c: char| !(c.is_ascii_digit() || "+-.e".contains(c)));
    digits[..end.unwrap_or(digits.len())].parse().ok()
}

/// The name of a mapped number in the text.
fn leaf(to: &str) -> &str {
    to.strip_prefix("gains.shaft.").unwrap_or(to)
}

/// Whether a text is of its format's language, as far as can be told without its program.
pub(super) fn is_of_its_language(format: &str, text: &str) -> Result<(), String> {
    let marks = match format {
        "bam" => {
            let parsed: Result<serde_json::Value, _> = serde_json::from_str(text);
            let value = parsed.map_err(|error| error.to_string())?;
            let model = value["model"].as_str().ok_or("no model")?;
            let humps = ["m2", "m4"].contains(&model);
            let shares = ["m3", "m4"].contains(&model);
            for (key, there) in [
                ("kt", true),
                ("R", true),
                ("armature", true),
                ("friction_base", true),
                ("friction_viscous", true),
                ("q_offset", true),
                ("command_delay", true),
                ("friction_stribeck", humps),
                ("dtheta_stribeck", humps),
                ("alpha", humps),
                ("load_friction_base", shares),
                ("load_friction_stribeck", humps && shares),
            ] {
                if value[key].is_f64() != there {
                    return Err(format!("{model}: {key}"));
                }
            }
            return Ok(());
        }
        "mjlab" | "ros2-control" | "odrive" | "moteus" => "#",
        "simscape" => "%",
        _ => ";",
    };
    for line in text.lines().filter(|line| !line.starts_with(marks)) {
        let body = line.split(marks).next().unwrap_or_default().trim_end();
        let fits = match format {
            "simscape" => body.starts_with("motor.") && body.ends_with(';'),
            "odrive" => body.starts_with("odrv0.axis0.") && body.contains(" = "),
            "vesc" => body.starts_with("(conf-set '") && body.ends_with(')'),
            "moteus" => body.split(' ').count() == 2,
            // Two spaces a level, and no tab.
            "ros2-control" => {
                let indent = line.len() - line.trim_start().len();
                indent % 2 == 0 && !line.contains('\t') && body.contains(':')
            }
            _ => true,
        };
        if !fits && !body.is_empty() {
            return Err(format!("not a line of {format}: {line}"));
        }
    }
    if format == "mjlab" && text.matches(['(', '[']).count() != text.matches([')', ']']).count() {
        return Err("brackets".to_owned());
    }
    Ok(())
}

#[test]
fn every_mapped_number_stands_in_the_text_under_its_name() {
    let mut seen = 0;
    for (format, case, _, written) in texts() {
        if !LINES.contains(&format) {
            continue;
        }
        for mapped in &written.mapping {
            let found = number(&written.text, leaf(&mapped.to));
            assert!(found.is_some(), "{case}: {mapped:?}\n{}", written.text);
            seen += 1;
        }
    }
    assert!(seen > 1000, "{seen}");
}

fn made(name: &str, subject: &Subject, options: &Options) -> Written {
    let format = Format::by_name(name).expect("a format");
    (format.write)(subject, options).expect("a text")
}

fn close(found: Option<f64>, expected: f64, what: &str) {
    let found = found.unwrap_or_else(|| panic!("{what} is not there"));
    assert!(
        (found / expected - 1.0).abs() < 1e-6,
        "{what}: {found}, not {expected}"
    );
}

#[test]
fn simulators_have_the_torques_of_the_motor() {
    for name in bench::PRESETS {
        let motor = bench::Machine::preset(name).expect("a preset");
        // What is found of Kt changes the torques, and not the shape of the text.
        let motor = bench::Machine {
            kt_n_m_a: 0.8 * motor.kt_n_m_a,
            ..motor
        };
        for (side, turns) in [(Side::Motor, 1.0), (OUTPUT, 30.0)] {
            let found = result(&motor, &[Kind::Coulomb], Known::All);
            let subject = subject(&found, side);
            let stall = motor.supply_v * motor.kt_n_m_a / motor.resistance_ohm * turns;
            let speed = motor.supply_v / motor.kb_v_s_rad / turns;
            let coulomb = subject.terms[0].values[0] / subject.volts_per_torque().expect("R/Kt");
            let inertia = motor.inertia_kg_m2 * turns * turns;
            let viscous = motor.viscous_n_m_s * turns * turns;
            let text = made("mjlab", &subject, &Options::default()).text;
            for (key, expected) in [
                ("saturation_effort", stall),
                ("effort_limit", 2.0 * stall),
                ("velocity_limit", speed),
                ("armature", inertia),
                ("viscous_damping", viscous),
                ("frictionloss", coulomb),
            ] {
                close(number(&text, key), expected, &format!("{name}: {key}"));
            }
            for (format, constant, resistance, base) in [
                ("bam", "kt", "R", "friction_base"),
                ("simscape", "motor.K", "motor.Ra", "motor.TC"),
            ] {
                let text = made(format, &subject, &Options::default()).text;
                let [k, r] = [constant, resistance].map(|key| number(&text, key).expect(key));
                close(Some(motor.supply_v * k / r), stall, format);
                close(Some(motor.supply_v / k), speed, format);
                close(number(&text, base), coulomb, format);
            }
        }
    }
}

#[test]
fn bam_s_models_follow_from_the_effects() {
    let motor = bench::Machine::gearmotor();
    for (kinds, model) in [
        (&[][..], "m1"),
        (&[Kind::Coulomb], "m1"),
        (&[Kind::Stribeck], "m2"),
        (&[Kind::LoadFriction], "m3"),
        (&[Kind::LoadFriction, Kind::Stribeck], "m4"),
    ] {
        let subject = subject(&result(&motor, kinds, Known::All), Side::Motor);
        let written = made("bam", &subject, &Options::default());
        let value: serde_json::Value = serde_json::from_str(&written.text).expect("JSON");
        assert_eq!(value["model"], model, "{kinds:?}");
        for &kind in kinds {
            let lost = written
                .cannot_carry
                .iter()
                .any(|lack| lack.what == kind.name());
            assert!(!lost, "{kinds:?}: {:?}", written.cannot_carry);
        }
        if let Some(at) = kinds.iter().position(|&kind| kind == Kind::Stribeck) {
            let ratio = subject.volts_per_torque().expect("R/Kt");
            let own = &subject.terms[at].values;
            close(value["friction_base"].as_f64(), own[0] / ratio, "base");
            close(value["friction_stribeck"].as_f64(), own[1] / ratio, "hump");
            close(value["dtheta_stribeck"].as_f64(), own[2], "speed");
        }
    }
}

#[test]
fn drives_have_a_phase_in_their_maker_s_units() {
    let motor = bench::Machine::gearmotor();
    let subject = subject(&linear(&motor, Known::All), Side::Motor);
    for (winding, in_series, peaks) in [
        (Winding::Line, 2.0, 3.0_f64.sqrt()),
        (Winding::Phase, 1.0, 1.0),
    ] {
        let options = Options {
            winding,
            pole_pairs: Some(7),
            ..Options::default()
        };
        let ohm = motor.resistance_ohm / in_series;
        let henry = subject.machine.electrical * ohm;
        let emf = motor.kb_v_s_rad / peaks;
        // Between lines, in rpm/V.
        let kv = 60.0 / TAU / (3.0_f64.sqrt() * emf);
        let odrive = made("odrive", &subject, &options).text;
        let vesc = made("vesc", &subject, &options).text;
        let moteus = made("moteus", &subject, &options).text;
        for (text, key, expected) in [
            (&odrive, "config.motor.phase_resistance", ohm),
            (&odrive, "config.motor.phase_inductance", henry),
            (&odrive, "config.motor.pole_pairs", 7.0),
            (
                &odrive,
                "controller.config.inertia",
                motor.inertia_kg_m2 * TAU,
            ),
            (&vesc, "foc-motor-r", 1e3 * ohm),
            (&vesc, "foc-motor-l", 1e6 * henry),
            (&vesc, "foc-motor-flux-linkage", 1e3 * emf / 7.0),
            (&vesc, "foc-current-kp", 1e3 * henry),
            (&vesc, "foc-current-ki", 1e3 * ohm),
            (&vesc, "si-motor-poles", 14.0),
            (&moteus, "motor.resistance_ohm", ohm),
            (&moteus, "motor.inductance_q_H", henry),
            (&moteus, "motor.Kv", kv),
            (&moteus, "motor.poles", 14.0),
            (&moteus, "servo.pid_dq_hz", 1e3 / TAU),
        ] {
            close(number(text, key), expected, &format!("{winding:?}: {key}"));
        }
        // ODrive's own formula has three digits.
        let torque = number(&odrive, "config.motor.torque_constant").expect("a constant");
        assert!((torque * kv / 8.27 - 1.0).abs() < 1e-3, "{torque}");
        // The same torque by three ways.
        close(Some(torque), 1.5 * emf, "torque");
        let flux = number(&vesc, "foc-motor-flux-linkage").expect("a flux");
        close(Some(1.5 * 7.0 * flux * 1e-3), torque, "flux");
    }
    // Another shaft than the winding's is refused with the remedy.
    let output = super::super::samples::subject(&linear(&motor, Known::All), OUTPUT);
    for name in ["odrive", "vesc", "moteus"] {
        let error = write(Format::by_name(name).expect("a format"), &output);
        let error = error.expect_err("refused").to_string();
        assert!(
            error.contains("--side output") && error.contains(name),
            "{error}"
        );
    }
    // Without the pairs of poles there is no flux linkage, and it is said.
    let none = made("vesc", &subject, &Options::default());
    assert!(number(&none.text, "foc-motor-flux-linkage").is_none());
    assert!(
        none.cannot_carry
            .iter()
            .any(|lack| lack.why.contains("--pole-pairs"))
    );
}

#[test]
fn the_speed_loops_of_drives_are_those_of_the_gains() {
    let motor = bench::Machine::gearmotor();
    let subject = subject(&linear(&motor, Known::All), Side::Motor);
    let gains = |loops: &str| -> toml::Table {
        let mut options = Options::default();
        options.gains.loops = Some(match loops {
            "cascade" => super::super::gains::Loops::Cascade,
            _ => super::super::gains::Loops::Voltage,
        });
        made("gains", &subject, &options)
            .text
            .parse()
            .expect("TOML")
    };
    let of =
        |table: &toml::Table, key: &str| table["speed_loop"][key].as_float().expect("a number");
    let cascade = gains("cascade");
    let odrive = made("odrive", &subject, &Options::default()).text;
    for (key, ours) in [("vel_gain", "kp"), ("vel_integrator_gain", "ki")] {
        let expected = of(&cascade, ours) * motor.kt_n_m_a * TAU;
        close(
            number(&odrive, &format!("controller.config.{key}")),
            expected,
            key,
        );
    }
    let volts = gains("voltage");
    let ros = made("ros2-control", &subject, &Options::default()).text;
    for (key, expected) in [
        ("p", of(&volts, "kp")),
        ("i", of(&volts, "ki")),
        ("i_clamp_max", motor.supply_v),
        ("i_clamp_min", -motor.supply_v),
        ("update_rate", 1000.0),
        (
            "feedforward_gain",
            motor.kb_v_s_rad + subject.machine.damping,
        ),
    ] {
        close(number(&ros, key), expected, key);
    }
}
