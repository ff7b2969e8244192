//! A drive that closes a position loop: the log has targets and angles, and nobody logged a voltage.

use crate::contract::{list, number, parameter};
use crate::desk::Desk;
use serde_json::Value;

/// The bench's gearmotor.
const GAIN: f64 = 58.36;
const A1_S: f64 = 0.02527;

fn value(result: &Value, name: &str) -> f64 {
    number(parameter(result, name), "value")
}

fn near(what: &str, value: f64, truth: f64, part: f64) {
    let off = value / truth - 1.0;
    println!("{what}: {value}, {:.2} % off", 100.0 * off);
    assert!(off.abs() < part, "{what}: {value} is not {truth}");
}

/// Two logs of one motor with hidden Coulomb friction behind a position loop, and its motor file.
fn desk(reach: &str) -> Desk {
    let desk = Desk::new();
    for (seed, name) in [(1, "a"), (2, "b")] {
        desk.done(&format!(
            "simulate --drive position --loop gain_v_per_rad=3 --reach {reach} --seconds 8 --hide coulomb --seed {seed} --out {name}.csv"
        ));
    }
    desk
}

/// As `motor.toml`, but without the loop's gain.
fn forget_the_gain(desk: &Desk) {
    let known = desk.read("motor.toml");
    let kept = known
        .lines()
        .filter(|line| !line.starts_with("gain_v_per_rad"));
    desk.write("motor.toml", kept.collect::<Vec<_>>().join("\n"));
}

#[test]
fn friction_is_named_behind_the_loop() {
    let desk = desk("1");
    let log = desk.read("a.csv");
    assert!(
        log.contains("t_s,target_counts,angle_counts"),
        "{}",
        &log[..200]
    );
    let found = desk.json("diagnose a.csv --validate b.csv");
    let named: Vec<&str> = (list(&found, "steps").iter())
        .filter_map(|step| step["added"].as_str())
        .collect();
    assert!(
        named.contains(&"coulomb"),
        "{named:?}: {}",
        found["summary"]
    );
    let last = &found["final"];
    near("gain", value(last, "gain"), GAIN, 0.01);
    near("a1", value(last, "a1"), A1_S, 0.03);
    let known = &list(&found, "position_loops")[0];
    assert_eq!(known["gain_v_per_rad"], 3.0);
    assert_eq!(known["gain_estimated"], false);
    let replayed = list(&found, "recordings").iter();
    let replayed: Vec<f64> = replayed
        .map(|one| number(one, "replay_rms_counts"))
        .collect();
    println!("driven by its loop: {replayed:?} counts RMS");
    assert_eq!(replayed.len(), 2);
    assert!(replayed.iter().all(|rms| *rms < 2.0), "{replayed:?}");
    // A loop that is not the one that drove the motor.
    let strange = desk
        .json("fit a.csv --with coulomb --loop gain_v_per_rad=3 --loop damping_v_s_per_rad=0.02");
    let notes = list(&strange, "notes").iter();
    let told = notes.filter_map(|note| note.as_str());
    assert!(
        told.into_iter()
            .any(|note| note.contains("driven by its position loop"))
    );
}

#[test]
fn a_gain_that_nobody_knows_is_told_by_the_limit() {
    let desk = desk("1");
    forget_the_gain(&desk);
    let fit = desk.json("fit a.csv --with coulomb --window 0.5");
    let told = &list(&fit, "position_loops")[0];
    assert_eq!(told["gain_estimated"], true);
    near(
        "gain of the loop",
        number(told, "gain_v_per_rad"),
        3.0,
        0.03,
    );
    near("gain", value(&fit, "gain"), GAIN, 0.05);
    near("a1", value(&fit, "a1"), A1_S, 0.1);
    let text = desk.done("fit a.csv --with coulomb --window 0.5").stdout;
    assert!(
        text.contains("position loop of") && text.contains("estimated"),
        "{text}"
    );
    let text = desk.done("check a.csv").stdout;
    assert!(text.contains("--loop gain_v_per_rad="), "{text}");
}

#[test]
fn without_the_limit_no_gain_is_made_up() {
    let desk = desk("0.1");
    forget_the_gain(&desk);
    let refused = desk.run("fit a.csv");
    assert_eq!(refused.code, Some(1), "{}", refused.stderr);
    for says in [
        "volts cannot be told",
        "gain_v_per_rad",
        "a step of the target large enough",
    ] {
        assert!(refused.stderr.contains(says), "{}", refused.stderr);
    }
    desk.done("fit a.csv --loop gain_v_per_rad=3 --with coulomb");
}

#[test]
fn every_slip_with_a_position_drive_names_its_flag() {
    let desk = desk("1");
    for (line, code, says) in [
        ("fit a.csv --loop gain=3", 2, "--loop gain=3"),
        ("fit a.csv --loop gain_v_per_rad=x", 2, "not a number"),
        ("fit a.csv --loop limit_v=-3", 2, "--loop limit_v=-3"),
        (
            "fit a.csv --drive voltage --loop limit_v=3",
            2,
            "--loop limit_v=3",
        ),
        ("fit a.csv --column voltage=target_counts", 2, "target"),
        ("fit a.csv --drive voltage", 1, "voltage_v"),
        (
            "simulate --loop limit_v=3 --out c.csv",
            2,
            "--drive position",
        ),
        (
            "simulate --drive position --reach 0 --out c.csv",
            2,
            "--reach",
        ),
        (
            "simulate --drive position --loop rate_hz=1 --out c.csv",
            2,
            "rate_hz",
        ),
    ] {
        let outcome = desk.run(line);
        assert_eq!(outcome.code, Some(code), "{line}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(says), "{line}: {}", outcome.stderr);
    }
}

#[test]
fn a_target_in_another_unit_is_noticed() {
    let desk = desk("1");
    let text = desk
        .done("check a.csv --column target=target_counts --unit target=rev")
        .stdout;
    assert!(text.contains("two units"), "{text}");
}
