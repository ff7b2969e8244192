//! The virtual bench: everything that it lists can be ordered, and leaves its mark.

use crate::contract::number;
use crate::desk::Desk;

/// Names in one section of `simulate --list`.
fn listed(section: &str) -> Vec<String> {
    let list = Desk::new().done("simulate --list").stdout;
    let names: Vec<String> = list
        .lines()
        .skip_while(|line| !line.starts_with(section))
        .skip(1)
        .take_while(|line| line.starts_with(' '))
        .filter_map(|line| line.split_whitespace().next().map(str::to_owned))
        .collect();
    assert!(names.len() >= 4, "{section}: {names:?}");
    names
}

#[test]
fn every_listed_effect_is_recorded_and_felt() {
    for name in listed("effects") {
        let desk = Desk::new();
        let made = desk.json(&format!("simulate --seconds 4 --hide {name} --out rec.csv"));
        assert_eq!(made["schema"], "servoid.simulate/1");
        assert!(
            made["hidden"][0]
                .as_str()
                .is_some_and(|text| text.starts_with(&name)),
            "{made}"
        );
        assert!(
            desk.read("rec.csv").contains(&format!("# hidden: {name}")),
            "{name}"
        );
        let fit = desk.json("fit rec.csv");
        // Twice the floor of the encoder at the least, or hiding it would prove nothing.
        assert!(
            number(&fit, "rms_counts") > 0.6,
            "{name}: {}",
            fit["rms_counts"]
        );
    }
}

#[test]
fn every_listed_motor_under_every_listed_excitation_is_fitted_to_the_quantiser() {
    for machine in listed("motors") {
        let excites = |name: &&String| *name != "rest";
        for excitation in listed("excitations").iter().filter(excites) {
            let desk = Desk::new();
            desk.done(&format!(
                "simulate --machine {machine} --excite {excitation} --out rec.csv"
            ));
            let fit = desk.json("fit rec.csv");
            assert!(
                number(&fit, "rms_counts") <= 0.30,
                "{machine}, {excitation}: {fit:#}"
            );
        }
    }
}

#[test]
fn several_effects_hide_together() {
    let desk = Desk::new();
    desk.done(
        "simulate --seconds 2 --hide coulomb:strength=2 --hide cogging --hide delay --out rec.csv",
    );
    let recording = desk.read("rec.csv");
    assert_eq!(
        recording
            .lines()
            .filter(|line| line.starts_with("# hidden: "))
            .count(),
        3
    );
}

#[test]
fn motor_toml_is_written_beside_unless_unwanted() {
    let desk = Desk::new();
    desk.write("with/.keep", "");
    desk.write("without/.keep", "");
    desk.done("simulate --seconds 1 --counts-per-rev 512 --out with/rec.csv");
    assert!(
        desk.read("with/motor.toml")
            .contains("counts_per_rev = 512")
    );
    desk.done("simulate --seconds 1 --no-motor --out without/rec.csv");
    assert!(!desk.path("without/motor.toml").exists());
    desk.refused(
        "fit without/rec.csv",
        1,
        &["counts_per_rev", "--counts-per-rev"],
    );
}

#[test]
fn a_motor_file_that_is_there_is_kept() {
    let own = "counts_per_rev = 512.0\n[known]\nresistance_ohm = 1.2\n";
    let desk = Desk::new();
    desk.write("motor.toml", own);
    let made = desk.done("simulate --seconds 1 --out rec.csv");
    assert_eq!(desk.read("motor.toml"), own, "{made}");
    for word in [
        "motor.toml",
        "kept",
        "counts_per_rev = 512",
        "2000",
        "supply_v",
    ] {
        assert!(made.stderr.contains(word), "{word}: {made}");
    }
    // The bench's own file agrees with the next recording of the same motor.
    let desk = Desk::new();
    desk.done("simulate --seconds 1 --out first.csv");
    let written = desk.read("motor.toml");
    let again = desk.done("simulate --seconds 1 --seed 2 --out second.csv");
    assert_eq!(again.stderr, "", "{again}");
    assert_eq!(desk.read("motor.toml"), written);
}

#[test]
fn the_list_is_the_same_in_json() {
    let list = Desk::new().json("simulate --list");
    assert_eq!(list["schema"], "servoid.simulate-list/1");
    let names = |key: &str| -> Vec<String> {
        let entries = list[key].as_array().expect("a list");
        let name = |entry: &serde_json::Value| {
            let name = entry.as_str().or(entry["name"].as_str());
            name.expect("a name").to_owned()
        };
        entries.iter().map(name).collect()
    };
    assert_eq!(names("machines"), listed("motors"));
    assert_eq!(names("effects"), listed("effects"));
    assert_eq!(names("excitations"), listed("excitations"));
}
