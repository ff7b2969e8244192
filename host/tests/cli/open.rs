//! Logs of strangers: opened, and fitted by the command that `servoid open` prints.

use super::desk::Desk;
use std::fs;
use std::path::PathBuf;
use testing::recordings::elsewhere;

/// A log made by its format's own library.
fn fixture(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("formats/tests/fixtures")
        .join(name)
}

/// Raw recordings as their makers wrote them: file, and the flags with which they are fitted.
const RAW: &[(&str, &str)] = &[
    (
        "raw/frc_simple_sysid.json",
        "--preset sysid --counts-per-rev 8192",
    ),
    (
        "raw/bam_xl330_up_and_down_kp400.json",
        "--preset bam --supply-v 7.4",
    ),
    ("raw/qube_00.csv", "--motor qube.toml"),
    ("raw/fra233_g04_step_1.mat", "--motor fra233.toml"),
    ("raw/odrive_slow2_nocomp_0.npy", "--motor odrive.toml"),
];

const MOTORS: &[(&str, &str)] = &[
    (
        "qube.toml",
        "counts_per_rev = 2048\n[columns]\ntime = \"t\"\nvoltage = \"plant_input\"\nangle = \"theta\"\n[units]\nangle = \"rad\"\n",
    ),
    (
        "fra233.toml",
        "counts_per_rev = 8192\n[columns]\ntime = \"Time\"\nvoltage = \"Input\"\nangle = \"Velo\"\n[units]\nangle = \"rad/s\"\n",
    ),
    (
        "odrive.toml",
        // An observer's angle in parts of a count: a travel of 8192 a revolution.
        "counts_per_rev = 8192\nmetres_per_rev = 8192\n[columns]\ntime = \"[0]\"\nvoltage = \"[2]\"\nangle = \"[1]\"\n\
         [units]\nvoltage = \"A\"\nangle = \"m\"\n[drive]\nkind = \"current\"\n",
    ),
];

#[test]
fn raw_logs_are_fitted_by_one_command_with_two_flags() {
    let desk = Desk::new();
    for (name, text) in MOTORS {
        desk.write(name, text);
    }
    for (file, flags) in RAW {
        let Some(path) = elsewhere(file) else {
            continue;
        };
        let fit = desk.json(&format!(
            "fit {} {flags} --with coulomb --force --budget 300",
            path.display()
        ));
        assert!(fit["rms_counts"].is_number(), "{file}");
    }
}

#[test]
fn every_log_is_opened_and_says_what_is_in_it() {
    let desk = Desk::new();
    for folder in [
        "compressed",
        "hdf5",
        "json",
        "matlab",
        "mcap",
        "numpy",
        "parquet",
        "wpilog",
    ] {
        for entry in fs::read_dir(fixture(folder)).expect("a folder of fixtures") {
            let path = entry.expect("an entry").path();
            let name = path
                .file_name()
                .and_then(|name| name.to_str())
                .unwrap_or_default();
            let outcome = desk.run(&format!("open {} --json opened.json", path.display()));
            assert!(
                matches!(outcome.code, Some(0 | 1)),
                "{name}: {}",
                outcome.stderr
            );
            if outcome.code == Some(1) {
                assert!(outcome.stderr.contains(name), "{name}: {}", outcome.stderr);
                continue;
            }
            let opened = desk.read_json("opened.json");
            assert_eq!(opened["schema"], "servoid.open/1", "{name}");
            let command = opened["command"].as_str().expect("a command");
            assert!(command.starts_with("servoid fit"), "{name}: {command}");
        }
    }
    let opened = desk.json(&format!("open {}", fixture("lerobot/v3").display()));
    assert_eq!(opened["tables"][0]["name"], "episode 0");
}

#[test]
fn the_command_that_is_printed_fits_the_log() {
    let desk = Desk::new();
    desk.done("simulate --hide coulomb --seconds 4 --counts-per-rev 2048 --out bench.csv");
    // The same log, as somebody else writes it.
    let mut text = "Bench 3;today\nZeit_ms;Voltage;Encoder\n[ms];[V];[1]\n".to_owned();
    for line in desk
        .read("bench.csv")
        .lines()
        .filter(|line| !line.starts_with(['#', 't']))
    {
        let cells: Vec<&str> = line.split(',').collect();
        let ms: f64 = 1e3 * cells[0].parse::<f64>().expect("a time");
        text += &format!("{ms};{};{}\n", cells[1], cells[2]).replace('.', ",");
    }
    desk.write("foreign/log.csv", text.as_bytes());
    let opened = desk.json("open foreign/log.csv --column time=Zeit_ms --unit time=ms");
    let needs = opened["needs"].as_array().expect("a list");
    assert_eq!(needs.len(), 1, "{needs:?}");
    let said = desk
        .done("open foreign/log.csv --column time=Zeit_ms --unit time=ms")
        .stdout;
    assert!(said.contains("--counts-per-rev N"), "{said}");
    let own =
        "--column time=Zeit_ms --unit time=ms --column voltage=Voltage --column angle=Encoder";
    let line =
        format!("fit foreign/log.csv {own} --counts-per-rev 2048 --with coulomb --write-motor");
    let foreign = desk.json(&line);
    let bench = desk.json("fit bench.csv --with coulomb");
    let errors =
        ["rms_counts"].map(|key| [&foreign, &bench].map(|fit| fit[key].as_f64().expect(key)));
    for [foreign, bench] in errors {
        assert!(
            (foreign - bench).abs() < 1e-6 * bench.max(1.0),
            "{foreign} for {bench}"
        );
    }
    // What was said is kept: now the log is read without flags.
    let again = desk.json("fit foreign/log.csv --with coulomb");
    assert_eq!(again["rms_counts"], foreign["rms_counts"]);
}

#[test]
fn columns_of_several_tables_are_joined() {
    let desk = Desk::new();
    let log = fixture("wpilog/robot.wpilog");
    let line = format!(
        "check {} --column voltage=/arm/voltage --column angle=/arm/counts --counts-per-rev 2048 --json -",
        log.display()
    );
    let outcome = desk.run(&line);
    assert!(
        outcome.stdout.contains("\"samples\": 30"),
        "{}{}",
        outcome.stdout,
        outcome.stderr
    );
    assert!(
        outcome.stderr.contains("each holds until its next value"),
        "{}",
        outcome.stderr
    );
}

#[test]
fn every_effect_is_told_and_all_are_listed() {
    let desk = Desk::new();
    let all = desk.json("effects");
    let effects = all["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), shared::effects::Kind::ALL.len());
    for effect in effects {
        let name = effect["name"].as_str().expect("a name");
        let said = desk.done(&format!("effects {name}")).stdout;
        for key in [
            "equation",
            "symptom",
            "experiment",
            "remedy",
            "look-alikes",
            "source",
        ] {
            assert!(said.contains(key), "{name}: {key}\n{said}");
        }
        let remedy = effect["remedy"].as_str().expect("a remedy");
        assert!(remedy.split(' ').count() > 4, "{name}: {remedy}");
    }
    desk.refused("effects colomb", 2, &["coulomb"]);
}
