//! Laws of the user's own: hidden, fitted, named, written and read again.

use super::desk::Desk;
use serde_json::Value;

/// A law without blanks, as a line of a shell takes it without quotes.
fn tight(law: &str) -> String {
    law.replace(' ', "")
}

/// Friction with an exponential fall, which no effect of the catalogue is exactly.
const FALLING: &str =
    "dry: friction = c*exp(-abs(w)/ws); c = 0.8 in [0, 5] V; ws = 40 in [2, 200] rad/s";
/// Drag on a broken power of the speed.
const DRAG: &str = "drag: torque = -c*sgn(w)*abs(w/w0)^p; c = 1.2 in [0, 10] V; p = 0.5 in [0.1, 4]; w0 = 100 rad/s";
/// The inertia of a crank, which passes two dead centres in a revolution.
const CRANK: &str =
    "crank: inertia = a*(1 + cos(theta - f)); a = 0.2 in [0, 4]; f = 0.7 in [-6.3, 6.3] rad";
/// Drag that sets in as the bearings' grease gives way.
const AGEING: &str = "ageing: torque = -c*w/w0*(1 - exp(-t/t0)); c = 1.5 in [0, 10] V; t0 = 5 in [0.1, 100] s; w0 = 300 rad/s";
/// The loss of a gear that follows its teeth (MuJoCo issue 3528).
const GEAR: &str = "gear: z' = (w - abs(w)*z)/h; torque = -(ma*abs(tau)*z + md*tau*z^2); h = 0.05 in [1e-3, 1] rad; ma = 0.2 in [0, 1]; md = 0.1 in [0, 1]";

/// Recordings of a motor that hides a law, so many seconds long.
fn recorded(desk: &Desk, law: &str, seconds: u32) {
    for (seed, file) in [(1, "rec.csv"), (2, "other.csv")] {
        desk.done(&format!(
            "simulate --seconds {seconds} --effect {} --seed {seed} --out {file}",
            tight(law)
        ));
    }
}

fn parameter(fit: &Value, name: &str) -> f64 {
    let parameters = fit["parameters"].as_array().expect("parameters");
    let found = parameters.iter().find(|p| p["name"] == name);
    found.unwrap_or_else(|| panic!("no {name} in {parameters:?}"))["value"]
        .as_f64()
        .expect("a number")
}

#[test]
fn a_law_that_is_hidden_is_found_again_by_its_text_and_read_from_its_result() {
    let laws = [
        (FALLING, &[("dry.c", 0.8), ("dry.ws", 40.0)][..]),
        (DRAG, &[("drag.c", 1.2), ("drag.p", 0.5)][..]),
        (CRANK, &[("crank.a", 0.2), ("crank.f", 0.7)][..]),
        (AGEING, &[("ageing.c", 1.5), ("ageing.t0", 5.0)][..]),
    ];
    for (law, known) in laws.into_iter().take(testing::length::cases(laws.len(), 2)) {
        let desk = Desk::new();
        recorded(&desk, law, 8);
        let law = tight(law);
        desk.done(&format!(
            "fit rec.csv --effect {law} --validate other.csv --json fit.json"
        ));
        let fit = desk.read_json("fit.json");
        for (name, truth) in known {
            let found = parameter(&fit, name);
            assert!(
                (found / truth - 1.0).abs() < 0.05,
                "{law}: {name} = {found}"
            );
        }
        assert_eq!(fit["model"]["formulas"][0], law, "the text is carried");
        // A program that never heard of the law reads the result.
        desk.done("export fit.json --to csv --out fit.csv");
    }
}

/// The drag of [`AGEING`] by the temperature that its recordings are given below.
const WARM: &str = "warm: torque = -c*w/w0*(temperature - t0)/t1; c = 0.5 in [0, 10] V; w0 = 300 rad/s; t0 = 20 degC; t1 = 50 degC";

/// A recording with a column of the temperature, of which every tenth row has a number, as a slow sensor has it.
fn warmed(text: &str) -> String {
    let mut begun = None;
    let mut row = 0;
    let lines = text.lines().map(|line| {
        let Ok(time) = line.split(',').next().unwrap_or_default().parse::<f64>() else {
            let header = line.starts_with("t_s");
            return format!("{line}{}\n", if header { ",case_temp" } else { "" });
        };
        let since = time - *begun.get_or_insert(time);
        row += 1;
        match row % 10 {
            1 => format!(
                "{line},{:.3}\n",
                293.15 + 50.0 * (1.0 - (-since / 5.0).exp())
            ),
            _ => format!("{line},\n"),
        }
    });
    lines.collect()
}

#[test]
fn a_law_of_the_temperature_is_found_where_the_recording_tells_it() {
    let desk = Desk::new();
    recorded(&desk, AGEING, 8);
    let law = tight(WARM);
    for (command, code, says) in [
        ("fit rec.csv", 1, "warm depends on the temperature"),
        ("compare rec.csv", 1, "a column of it"),
        ("diagnose rec.csv", 1, "a column of it"),
        ("simulate --out none.csv", 2, "tells no temperature"),
    ] {
        desk.refused(&format!("{command} --effect {law}"), code, &[says]);
    }
    for file in ["rec.csv", "other.csv"] {
        let text = desk.read(file);
        desk.write(file, warmed(&text));
    }
    let columns = "--column temperature=case_temp --unit temperature=K";
    desk.done(&format!(
        "fit rec.csv {columns} --effect {law} --validate other.csv --json fit.json"
    ));
    let fit = desk.read_json("fit.json");
    let found = parameter(&fit, "warm.c");
    assert!((found / 1.5 - 1.0).abs() < 0.02, "{found}");
    desk.done(&format!(
        "diagnose rec.csv {columns} --effect {law} --validate other.csv --json named.json"
    ));
    let named = desk.read_json("named.json");
    assert_eq!(named["steps"][0]["added"], "warm", "{named}");
}

#[test]
fn the_loss_of_a_gear_predicts_and_the_linear_motor_does_not() {
    let desk = Desk::new();
    recorded(&desk, GEAR, 8);
    let error = |flags: &str| {
        desk.done(&format!(
            "fit rec.csv {flags} --validate other.csv --json fit.json"
        ));
        let fit = desk.read_json("fit.json");
        fit["validate_rms_counts"].as_f64().expect("an error")
    };
    let (with, without) = (error(&format!("--effect {}", tight(GEAR))), error(""));
    assert!(
        with < 0.1 * without,
        "{with} counts with, {without} without"
    );
}

#[test]
fn a_law_is_a_candidate_of_a_diagnosis() {
    let desk = Desk::new();
    recorded(&desk, DRAG, 8);
    let law = tight(DRAG);
    desk.done(&format!(
        "diagnose rec.csv --validate other.csv --effect {law} --json found.json"
    ));
    let found = desk.read_json("found.json");
    assert_eq!(found["steps"][0]["added"], "drag");
    let left = found["final"]["validate_rms_counts"].as_f64();
    assert!(left.expect("an error") < 0.4, "{left:?} counts");
}

#[test]
fn faults_name_the_flag_the_character_and_the_remedy() {
    let desk = Desk::new();
    desk.done("simulate --seconds 1 --out rec.csv");
    desk.write(
        "bad.toml",
        "[effects]\na = \"torque = c*x; c in [0, 1] V\"\n",
    );
    desk.write("empty.toml", "a = 1\n");
    for (name, law) in [
        ("units", "torque = c*w; c in [0, 1] V*s"),
        ("coulomb", "torque = c; c in [0, 1] V"),
        ("zero", "torque = c/w*w0; c in [0, 1] V; w0 = 1 rad/s"),
        ("mass", "inertia = a*w/w0; a in [0, 1]; w0 = 1 rad/s"),
        ("dry", "friction = c*t/t0; c in [0, 1] V; t0 = 1 s"),
    ] {
        desk.write(
            &format!("{name}.toml"),
            format!("[effects]\n{name} = \"{law}\"\n"),
        );
    }
    for (flags, words) in [
        ("--effect a:torque=c", "is neither"),
        ("--effect a", "`:`"),
        ("--effects units.toml", "expected V, found"),
        ("--effects coulomb.toml", "catalogue"),
        ("--effects zero.toml", "divisor can be zero"),
        ("--effects mass.toml", "theta alone"),
        ("--effects dry.toml", "belongs to"),
        ("--effects bad.toml", "`x` is neither"),
        ("--effects empty.toml", "[effects]"),
        ("--effects none.toml", "none.toml"),
        (
            "--effect a:voltage=c;c=1in[0,2]V --effect a:torque=c;c=1in[0,2]V",
            "another name",
        ),
    ] {
        desk.refused(&format!("fit rec.csv {flags}"), 2, &[words]);
    }
}

#[test]
fn a_law_is_told_and_written_for_firmware() {
    let desk = Desk::new();
    desk.done(&format!(
        "effects --effect {} --emit-rust law.rs",
        tight(DRAG)
    ));
    assert!(desk.read("law.rs").contains("pub static DRAG: Formula"));
}
