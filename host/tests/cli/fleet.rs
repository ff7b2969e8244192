//! From recordings of many motors to their population and motors drawn from it.

use crate::contract::{has, list, number};
use crate::desk::Desk;
use std::fmt::Write;
use std::fs;

const MOTORS: usize = 30;

/// A batch of motors that differ in their friction, one of them three times what the others have.
fn batch(known: &str) -> Desk {
    let desk = Desk::new();
    fs::create_dir_all(desk.path("logs")).expect("a folder");
    let mut labels = String::from("unit,serial,lot,station,time\n");
    for motor in 0..MOTORS {
        let spread = ((motor * 7) % MOTORS) as f64 / MOTORS as f64 - 0.5;
        let part = if motor == 17 {
            0.009
        } else {
            0.003 * (1.0 + 0.2 * spread)
        };
        desk.done(&format!(
            "simulate --seconds 3 --hide coulomb:torque={part} --seed {motor} --out logs/{motor:02}.csv"
        ));
        let (lot, day) = (motor % 2, 1 + motor % 28);
        writeln!(
            labels,
            "{motor:02}.csv,S{motor},lot {lot},1,2026-03-{day:02}"
        )
        .expect("text");
    }
    let motor = desk.read("logs/motor.toml");
    desk.write("logs/motor.toml", format!("{motor}{known}"));
    desk.write("labels.csv", &labels);
    desk.write("logs/bad.csv", "t_s,voltage_v,angle_counts\n0,1,0\n");
    desk.done("batch logs --out results --do fit --with coulomb");
    desk
}

#[test]
fn the_odd_motor_is_named_with_the_reason_and_the_others_are_a_population() {
    let desk = batch("");
    let fleet = desk.json("fleet results --labels labels.csv --report fleet.html");
    has(
        &fleet,
        "schema: text, recordings: number, motors: number, refused: list, quantities: list, odd: list, lots: list, drifts: list",
    );
    assert_eq!(fleet["recordings"], MOTORS);
    assert_eq!(fleet["refused"][0]["recordings"], 1);
    let odd = list(&fleet, "odd");
    // All else of the bench's motors differs by errors only.
    assert!((1..=2).contains(&odd.len()), "{odd:#?}");
    assert_eq!([&odd[0]["unit"], &odd[0]["serial"]], ["17.csv", "S17"]);
    assert_eq!(odd[0]["reasons"][0]["name"], "coulomb.torque");
    assert!(
        odd[0]["reasons"][0]["text"]
            .as_str()
            .expect("text")
            .contains("above the usual")
    );
    assert_eq!(list(&fleet, "lots").len(), 2);
    let page = desk.read("fleet.html");
    assert!(page.contains("17.csv") && page.contains("coulomb.torque"));
    // What was found of it unfolds there.
    let (_, own) = page.split_once("data-name=\"17.csv\"").expect("it unfolds");
    let (own, _) = own.split_once("</details>").expect("its end");
    assert!(own.contains("<td>coulomb.torque</td>"), "{own}");
    // Its own page and its own result.
    let unit = desk.json("fleet results --unit 17.csv --report unit.html");
    assert_eq!(unit["schema"], "servoid.fit/1");
    assert!(desk.read("unit.html").contains("coulomb"));
    // The bench's machine is one: only friction differs.
    let population = desk.json("population results --labels labels.csv");
    assert_eq!(population["motors"], MOTORS - odd.len());
    assert_eq!(population["odd"], odd.len());
    let members = list(&population, "parameters");
    let friction = members
        .iter()
        .find(|one| one["name"] == "coulomb.torque")
        .expect("friction");
    let wide = number(friction, "std.value") / number(friction, "mean.value");
    assert!(
        (0.03..0.09).contains(&wide),
        "differs by {wide} of its mean"
    );
}

#[test]
fn motors_are_drawn_as_arrays_tables_and_models() {
    let desk = batch("[known]\nresistance_ohm = 2.3\nkt_equals_kb = true\nviscous_n_m_s = 1e-6\n");
    desk.done("population results --json population.json");
    let drawn = desk.json("draw population.json -n 500 --out motors.npz");
    assert_eq!(drawn["motors"], 500);
    assert!(
        list(&drawn, "names")
            .iter()
            .any(|name| name == "coulomb.torque")
    );
    desk.done("draw population.json -n 500 --to parquet --out motors.parquet");
    desk.done("draw population.json -n 3 --to mujoco --out three");
    desk.done("draw population.json -n 2 --to mujoco --out two");
    let models = |folder: &str| {
        let mut texts: Vec<String> = fs::read_dir(desk.path(folder))
            .expect("a folder")
            .map(|file| fs::read_to_string(file.expect("a file").path()).expect("a model"))
            .collect();
        texts.sort();
        texts
    };
    let (two, three) = (models("two"), models("three"));
    assert_eq!(three.len(), 3);
    assert!(
        two.iter().all(|model| three.contains(model)),
        "the first motors are the same"
    );
    assert!(three[0].contains("frictionloss") && three[0] != three[1]);
}

#[test]
fn what_cannot_be_said_is_said_with_the_remedy() {
    let desk = Desk::new();
    let refused = |line: &str, code: i32, says: &[&str]| desk.refused(line, code, says);
    refused("fleet nowhere", 1, &["nowhere"]);
    fs::create_dir_all(desk.path("empty/parts")).expect("a folder");
    refused("fleet empty", 1, &["holds no results", "servoid batch"]);
    desk.write("text.json", "{}");
    refused(
        "draw text.json --out a.npz",
        1,
        &["text.json", "servoid population"],
    );
    desk.write("labels.csv", "name,lot\na,1\n");
    refused(
        "fleet empty --labels labels.csv",
        1,
        &["labels.csv", "column unit"],
    );
    fs::create_dir_all(desk.path("logs")).expect("a folder");
    for seed in 1..4 {
        desk.done(&format!(
            "simulate --seconds 2 --hide coulomb --seed {seed} --out logs/{seed}.csv"
        ));
    }
    desk.done("batch logs --out few --do fit --with coulomb");
    refused("population few", 1, &["3 motors", "needs 8"]);
    refused("fleet few --unit 9.csv", 2, &["9.csv", "1.csv"]);
    // The page needs no population.
    desk.done("fleet few --report few.html");
    assert!(desk.read("few.html").contains("3 recordings"));
    let many = batch("");
    many.done("population results --json population.json");
    many.refused(
        "draw population.json -n 2 --to mujoco --out models",
        1,
        &["resistance"],
    );
    assert!(!many.path("models").exists());
}
