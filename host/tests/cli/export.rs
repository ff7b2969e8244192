//! `export`: from a recording to the files of other programs.

use crate::contract::{has, list, number};
use crate::desk::Desk;
use servoid_results::export::FORMATS;

/// A desk with the fits of a motor: `known.json` with the facts that settle everything, `volts.json` without.
fn fitted() -> Desk {
    let desk = Desk::new();
    desk.done("simulate --hide coulomb --excite commissioning-coast --out rec.csv");
    let fit = "fit rec.csv --with coulomb";
    desk.done(&format!(
        "{fit} --known resistance_ohm=2.3 --kt-equals-kb --json known.json"
    ));
    desk.done(&format!("{fit} --json volts.json"));
    desk
}

#[test]
fn a_fit_goes_into_every_format_and_the_file_is_what_stdout_shows() {
    let desk = fitted();
    for format in FORMATS {
        let name = format.name;
        let shown = desk.done(&format!("export known.json --to {name}"));
        desk.done(&format!("export known.json --to {name} --out out.{name}"));
        assert_eq!(desk.read(&format!("out.{name}")), shown.stdout, "{name}");
        let json = desk.json(&format!("export known.json --to {name}"));
        assert_eq!(json["schema"], "servoid.export/1");
        assert_eq!(json["format"], name);
        assert_eq!(json["text"], shown.stdout.as_str(), "{name}");
        has(
            &json,
            "source: text, side: object, mapping: list, cannot_carry: list, remarks: list, \
             version: text",
        );
        for mapped in list(&json, "mapping") {
            let keys = "from: text, to: text, unit: text, side: text";
            has(mapped, keys);
        }
        // What is left out stands on stderr too, unless nobody wants to hear it.
        for lack in list(&json, "cannot_carry") {
            let what = lack["what"].as_str().expect("text");
            assert!(shown.stderr.contains(what), "{name}: {what}\n{shown}");
        }
        let quiet = desk.done(&format!("export known.json --to {name} --quiet"));
        assert_eq!(
            (quiet.stderr.as_str(), &quiet.stdout),
            ("", &shown.stdout),
            "{name}"
        );
    }
}

#[test]
fn numbers_come_out_as_they_went_in_and_the_output_s_behind_its_gear() {
    let desk = fitted();
    let known = "export known.json --to wpilib";
    let constant = |line: &str, name: &str| -> f64 {
        let text = desk.done(line).stdout;
        let found = text
            .lines()
            .find_map(|line| line.split_once(&format!("double {name} = ")));
        let number = found.unwrap_or_else(|| panic!("{name}: {text}")).1;
        number.trim_end_matches(';').parse().expect("a number")
    };
    // The bench's motor: 0.36 V of Coulomb friction, Kb 17 mV·s/rad.
    assert!((constant(known, "kS") - 0.36).abs() < 1e-3);
    let k_v = constant(known, "kV");
    assert!((k_v - 0.017135).abs() < 1e-5, "{k_v}");
    let output = format!("{known} --side output --ratio 30");
    assert!((constant(&output, "kV") / k_v - 30.0).abs() < 1e-9);
    assert!((constant(&output, "kS") - constant(known, "kS")).abs() < 1e-12);
    // The next recording of the motor begins with what this one found.
    let toml = desk.done("export known.json --to toml").stdout;
    let section = toml.split_once("[known]").expect("a section").1;
    let section = section.split_once("\n\n").expect("an end").0;
    desk.write(
        "motor.toml",
        format!("counts_per_rev = 2000\n[known]{section}\n"),
    );
    let again = desk.json("fit rec.csv --with coulomb");
    let inertia = crate::contract::parameter(&again, "inertia");
    assert!((number(inertia, "value") / 3.2e-6 - 1.0).abs() < 1e-3);
}

#[test]
fn what_the_winding_was_and_how_many_poles_it_has_is_the_user_s_to_say() {
    let desk = fitted();
    let set = |line: &str| {
        desk.done(&format!("export known.json --to vesc {line}"))
            .stdout
    };
    assert!(
        set("").contains("(conf-set 'foc-motor-r 1150.0)"),
        "{}",
        set("")
    );
    let phase = set("--winding phase --pole-pairs 7 --current-bandwidth 100");
    for line in [
        "(conf-set 'foc-motor-r 2300.0)",
        "(conf-set 'si-motor-poles 14)",
    ] {
        assert!(phase.contains(line), "{phase}");
    }
    assert!(
        phase.contains("(conf-set 'foc-motor-flux-linkage 2.42"),
        "{phase}"
    );
    assert!(!set("").contains("flux-linkage "), "{}", set(""));
}

#[test]
fn a_diagnosis_can_be_exported_too() {
    let desk = Desk::new();
    desk.done("simulate --hide load_torque --excite steps --out rec.csv");
    desk.done("diagnose rec.csv --json diagnosis.json");
    let text = desk.done("export diagnosis.json --to wpilib").stdout;
    assert!(
        text.contains("servoid.diagnosis/1") && text.contains("kG"),
        "{text}"
    );
}

#[test]
fn what_the_data_do_not_determine_is_refused_with_the_remedy_or_left_out() {
    let desk = fitted();
    for format in ["mujoco", "urdf", "bam", "mjlab", "simscape"] {
        let line = format!("export volts.json --to {format} --out out.xml");
        desk.refused(&line, 1, &[format, "N*m", "--known resistance_ohm"]);
    }
    for format in ["odrive", "vesc", "moteus"] {
        let line = format!("export volts.json --to {format} --out out.txt");
        desk.refused(&line, 1, &[format, "ohm", "--known resistance_ohm"]);
        let line = format!("export known.json --to {format} --side output --ratio 30");
        desk.refused(&line, 1, &[format, "--side output"]);
    }
    let ros = desk.done("export volts.json --to ros2-control").stdout;
    assert!(ros.contains("update_rate: 1000\n"), "{ros}");
    let csv = desk.done("export volts.json --to csv").stdout;
    assert!(
        csv.contains("coulomb.torque,") && csv.contains(",V,"),
        "{csv}"
    );
    let gains = "export volts.json --to gains";
    assert!(desk.done(gains).stdout.contains("output in V"));
    desk.refused(
        &format!("{gains} --loops cascade"),
        1,
        &["resistance", "--known"],
    );
    desk.refused(
        &format!("{gains} --speed-bandwidth 300"),
        1,
        &["--speed-bandwidth 300", "phase margin", "--sample"],
    );
}

#[test]
fn wrong_use_is_refused_by_the_flag_s_name() {
    let desk = fitted();
    for (flags, says) in [
        ("", &["--to"][..]),
        ("--to fortran", &["fortran", "mujoco"]),
        ("--to c --ratio 30", &["--ratio 30", "--side output"]),
        ("--to c --side output", &["--side output", "--ratio"]),
        ("--to c --side output --ratio 0", &["--ratio 0", "positive"]),
        ("--to c --side output --ratio nan", &["--ratio", "positive"]),
        (
            "--to c --side output --ratio 1e200",
            &["--ratio", "between"],
        ),
        ("--to c --sample -1", &["--sample -1", "positive"]),
        ("--to csv --sample 1e-3", &["--sample", "gains"]),
        ("--to c --method cancel", &["--method", "--to gains"]),
        (
            "--to ros2-control --loops cascade",
            &["--loops", "--to gains"],
        ),
        ("--to csv --winding phase", &["--winding", "vesc"]),
        ("--to c --pole-pairs 7", &["--pole-pairs", "odrive"]),
        ("--to vesc --pole-pairs 0", &["--pole-pairs", "0"]),
        ("--to vesc --winding delta", &["--winding", "line"]),
        (
            "--to gains --speed-bandwidth inf",
            &["--speed-bandwidth", "positive"],
        ),
        ("--to c --out known.json", &["--out", "the result"]),
        ("--to c --json known.json", &["--json", "the result"]),
        ("--to c --out no/where.h", &["--out", "folder"]),
        ("--to c --out .", &["--out", "folder"]),
    ] {
        desk.refused(&format!("export known.json {flags}"), 2, says);
    }
}

#[test]
fn what_is_no_result_is_refused_and_nothing_is_written() {
    let desk = fitted();
    let fit = desk.read("known.json");
    desk.done("simulate --list --json list.json");
    desk.done("compare rec.csv --algorithm lm --seeds 1 --budget 50 --json compare.json");
    for (name, content, says) in [
        (
            "cut.json",
            fit[..fit.len() / 2].to_owned(),
            &["cut.json:", "servoid fit"][..],
        ),
        ("empty.json", String::new(), &["empty.json:1:0"]),
        (
            "nan.json",
            fit.replacen("\"value\": ", "\"value\": NaN, \"was\": ", 1),
            &["nan.json:"],
        ),
        (
            "null.json",
            fit.replacen("\"value\": ", "\"value\": null, \"was\": ", 1),
            &["null.json:", "null"],
        ),
        (
            "huge.json",
            fit.replacen("\"value\": ", "\"value\": 1e999, \"was\": ", 1),
            &["huge.json:"],
        ),
        (
            "old.json",
            fit.replace("\"model\"", "\"modell\""),
            &["no `model`", "again"],
        ),
        (
            "effect.json",
            fit.replace("coulomb", "colomb"),
            &["colomb", "coulomb"],
        ),
    ] {
        desk.write(name, &content);
        let line = format!("export {name} --to c --out motor.h");
        desk.refused(&line, 1, says);
    }
    for (name, says) in [
        ("nowhere.json", &["nowhere.json", "cannot be read"][..]),
        ("rec.csv", &["rec.csv:1:1"]),
        ("list.json", &["servoid.simulate-list/1", "servoid.fit/1"]),
        ("compare.json", &["servoid.compare/1"]),
        (".", &["device.json", "cannot be read"]),
    ] {
        desk.refused(&format!("export {name} --to c"), 1, says);
    }
}

#[test]
fn numbers_are_written_as_they_were_typed_and_what_is_missing_is_said() {
    let desk = fitted();
    let mujoco = desk.done("export known.json --to mujoco");
    assert!(mujoco.stdout.contains(" resistance=\"2.3\""), "{mujoco}");
    assert!(
        mujoco.stdout.contains("ctrlrange=") && !mujoco.stderr.contains("ctrlrange"),
        "{mujoco}"
    );
    for hertz in ["60", "7.3", "0.5"] {
        let line =
            format!("export known.json --to gains --loops voltage --speed-bandwidth {hertz}");
        let outcome = desk.run(&line);
        let typed: f64 = hertz.parse().expect("a number");
        let said = format!("{}{}", outcome.stdout, outcome.stderr);
        let back = [
            format!("crossover_hz = {typed:?}\n"),
            format!("--speed-bandwidth {typed:?}:"),
        ];
        assert!(back.iter().any(|text| said.contains(text)), "{outcome}");
    }
    let mut fit = desk.read_json("known.json");
    fit["supply_v"] = serde_json::Value::Null;
    desk.write("no-supply.json", fit.to_string());
    let outcome = desk.done("export no-supply.json --to mujoco");
    assert!(
        !outcome.stdout.contains("ctrlrange=") && outcome.stderr.contains("ctrlrange"),
        "{outcome}"
    );
    // A motor without back-EMF has no resistance there.
    for key in ["kb_v_s_rad", "damping_v_s_rad"] {
        fit["model"]["machine"][key] = 0.into();
    }
    desk.write("no-emf.json", fit.to_string());
    desk.refused("export no-emf.json --to mujoco", 1, &["mujoco", "back-EMF"]);
}
