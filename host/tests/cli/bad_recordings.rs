//! Recordings and motor files that must be refused: where, why, and what to do about it.

use std::fmt::Write;
use std::fs::File;

use crate::desk::Desk;

/// Asked for with every bad recording, so that "nothing written" means something.
const OUTPUTS: &str = "--json out.json --plot out.svg";

const HEADER: &str = "t_s,voltage_v,angle_counts\n";

/// Content of `rec.csv`, and what the message must say.
const BAD: &[(&str, &[&str])] = &[
    ("", &["rec.csv: is empty", "header row"]),
    ("# nothing but a remark\n\n", &["rec.csv: is empty"]),
    (
        "t_s,voltage_v,angle_counts\n",
        &["rec.csv: the recording has no sample", "at least two"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n",
        &["one sample", "at least two"],
    ),
    (
        "t_s,voltage_v\n0,1\n1,1\n",
        &["rec.csv:1:", "`angle_counts`", "[columns]"],
    ),
    (
        "time,volts,enc\n0,1,0\n1,1,9\n",
        &["rec.csv:1:", "`time`, `volts`, `enc`", "motor.toml"],
    ),
    ("0,1,0\n1,1,9\n", &["rec.csv:1:", "header row"]),
    (
        "t_s,voltage_v,t_s,angle_counts\n0,1,0,0\n",
        &["rec.csv:1:", "2 times", "rename"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,x,9\n",
        &["rec.csv:3:2", "voltage_v", "\"x\""],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,1,NaN\n",
        &["one sample", "at least two"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,inf,9\n",
        &["rec.csv:3:2", "infinite"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n2,1,5\n1,1,9\n",
        &["rec.csv:4:1", "goes back", "sort"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n0,1,5\n",
        &["rec.csv:3", "repeats"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,3000000000\n",
        &["rec.csv:2:3", "32-bit", "subtract"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,1,0.5\n",
        &["rec.csv:3:3", "[units]"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,\n1,1,\n",
        &["no row has an angle"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,1,5\n2,\n",
        &["rec.csv:4", "2 cells", "3"],
    ),
    (
        "t_s,voltage_v,angle_counts,enabled\n0,1,0,maybe\n",
        &["rec.csv:2:4", "neither 0 nor 1"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,1,0\n2,1,0\n",
        &["rec.csv", "never moved"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,0,0\n1,0,50\n2,0,99\n",
        &["rec.csv", "command is zero"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n1,1,1\n2,1,2\n",
        &["rec.csv", "only 2 counts"],
    ),
    (
        "t_s,voltage_v,angle_counts\n0,1,0\n.1,1,50\n.2,1,100\n",
        &["rec.csv"],
    ),
];

#[test]
fn bad_recordings_are_refused() {
    let desk = Desk::new();
    desk.write("motor.toml", "counts_per_rev = 2000\n");
    for (content, says) in BAD {
        desk.write("rec.csv", content);
        for verb in ["fit", "compare"] {
            desk.refused(&format!("{verb} rec.csv {OUTPUTS}"), 1, says);
        }
    }
}

#[test]
fn what_is_no_recording_is_refused() {
    let desk = Desk::with_recording();
    desk.write("folder/inside.txt", "");
    desk.write("line.csv", format!("{HEADER}{}", "0,".repeat(2_000_000)));
    desk.write(
        "binary.csv",
        [HEADER.as_bytes(), &[0xff, 0xfe, 0, 1]].concat(),
    );
    // A gigabyte that takes no room on the disk.
    let hole = File::create(desk.path("hole.csv")).expect("a file");
    hole.set_len(1 << 30).expect("a sparse file");
    for (name, says) in [
        ("missing.csv", "cannot be read"),
        ("folder", "is a folder"),
        ("line.csv", "line.csv:2"),
        ("binary.csv", "no sample"),
        ("hole.csv", "hole.csv:1"),
    ] {
        desk.refused(
            &format!("fit {name} --counts-per-rev 2000 {OUTPUTS}"),
            1,
            &[name, says],
        );
        desk.refused(
            &format!("fit rec.csv --validate {name} {OUTPUTS}"),
            1,
            &[name, says],
        );
    }
}

/// An encoder wired the other way round.
#[test]
fn a_wrong_sign_of_the_angle_is_named() {
    let desk = Desk::with_recording();
    let mut turned = String::from(HEADER);
    for row in desk
        .read("rec.csv")
        .lines()
        .filter(|row| row.starts_with(|c: char| c.is_ascii_digit()))
    {
        let (before, counts) = row.rsplit_once(',').expect("three cells");
        let counts: i64 = counts.parse().expect("counts");
        writeln!(turned, "{before},{}", -counts).expect("a string takes it");
    }
    desk.write("turned.csv", turned);
    desk.refused(
        &format!("fit turned.csv {OUTPUTS}"),
        1,
        &["turned.csv", "sign"],
    );
}

/// Lines of `motor.toml`, and what the message must say.
const BAD_MOTORS: &[(&str, &[&str])] = &[
    (
        "counts_per_rew = 2000",
        &["motor.toml:1:1", "`counts_per_rev`"],
    ),
    (
        "counts_per_rev = \"2000\"",
        &["motor.toml:1:18", "without quotes"],
    ),
    (
        "counts_per_rev = 0",
        &["motor.toml:1:18", "greater than zero"],
    ),
    ("counts_per_rev = nan", &["motor.toml:1:18", "finite"]),
    ("[units]\nangle = \"grad\"", &["motor.toml:2:9", "`deg`"]),
    (
        "[known]\nresistance = 1",
        &["motor.toml:2:1", "`resistance_ohm`"],
    ),
    (
        "[drive]\nkind = \"torque\"",
        &["motor.toml:2:8", "`current`"],
    ),
    ("not toml", &["motor.toml:1:", "TOML"]),
    ("supply_v = 12", &["counts_per_rev", "--counts-per-rev"]),
    (
        "counts_per_rev = 2000\n[units]\nvoltage = \"duty\"",
        &["supply"],
    ),
    (
        "counts_per_rev = 2000\n[units]\nangle = \"m\"",
        &["metres_per_rev"],
    ),
];

#[test]
fn bad_motor_files_are_refused() {
    let desk = Desk::with_recording();
    for (content, says) in BAD_MOTORS {
        desk.write("motor.toml", content);
        desk.refused(&format!("fit rec.csv {OUTPUTS}"), 1, says);
    }
    desk.refused(
        "fit rec.csv --motor missing.toml",
        1,
        &["missing.toml", "cannot be read"],
    );
    desk.refused("fit rec.csv --motor rec.csv", 1, &["rec.csv:", "TOML"]);
}

#[test]
fn a_remedy_in_a_flag_is_named() {
    let desk = Desk::new();
    desk.write("rec.csv", format!("{HEADER}0,1,0\n1,1,9\n"));
    let fit = "fit rec.csv --counts-per-rev 2000 --supply-v 12";
    desk.refused(
        &format!("{fit} --column angle=x"),
        1,
        &["`x`", "or give --column angle="],
    );
    desk.refused(&format!("{fit} --unit angle=m"), 1, &["--metres-per-rev"]);
}

#[test]
fn a_duty_in_percent_is_refused() {
    let desk = Desk::new();
    desk.write("rec.csv", format!("{HEADER}0,0.5,0\n1,50,9\n"));
    desk.refused(
        "fit rec.csv --counts-per-rev 2000 --supply-v 12 --unit voltage=duty",
        1,
        &["rec.csv:3:2", "percent", "--unit voltage=percent"],
    );
}

/// A motor that speeds up, logged modulo one turn from `least` on, in whatever unit a turn is `turn` of.
fn wrapping(turn: f64, least: f64, whole: bool) -> String {
    let mut text = HEADER.to_owned();
    for k in 0..1000 {
        let t = f64::from(k) * 1e-3;
        let turns = 10.0 * (t - 0.05 * (1.0 - (-t / 0.05).exp()));
        let angle = (turns * turn - least).rem_euclid(turn) + least;
        let angle = if whole { angle.floor() } else { angle };
        writeln!(text, "{t},6,{angle}").expect("a string");
    }
    text
}

#[test]
fn an_angle_that_wraps_is_unwrapped_whatever_its_turn() {
    let tau = std::f64::consts::TAU;
    for (turn, least, unit, whole) in [
        (2000.0, 0.0, "counts", true),
        (2000.0, -1000.0, "counts", true),
        (256.0, 0.0, "counts", true),
        (1024.0, -512.0, "counts", true),
        (tau, -tau / 2.0, "rad", false),
        (tau, 0.0, "rad", false),
        (360.0, 0.0, "deg", false),
        (1.0, 0.0, "rev", false),
    ] {
        let desk = Desk::new();
        desk.write("rec.csv", wrapping(turn, least, whole));
        let fit = format!("fit rec.csv --counts-per-rev 2000 --unit angle={unit}");
        let said = desk.done(&fit).stderr;
        assert!(said.contains("it is unwrapped"), "{turn} {unit}: {said}");
    }
}

/// Strokes of nearly a turn between two slow samples are motion, not wraps.
#[test]
fn an_axis_that_goes_to_and_fro_does_not_wrap() {
    let desk = Desk::new();
    let mut text = HEADER.to_owned();
    for k in 0..200_u32 {
        let up = k / 5 % 2 == 1;
        let angle = if up { 230 } else { 0 } + i32::from(k % 5 > 0) * if up { 3 } else { -3 };
        let voltage = if up { 6 } else { -6 };
        writeln!(text, "{},{voltage},{angle}", f64::from(k) * 0.1).expect("a string");
    }
    desk.write("rec.csv", text);
    let outcome = desk.run("fit rec.csv --counts-per-rev 2000");
    assert!(!outcome.stderr.contains("unwrap"), "{outcome}");
}
