//! Motor files: the contract's own, and those that must be refused with place and remedy.

use servoid_io::input::{AngleUnit, Fact, MotorFile};
use servoid_io::recording::Drive;

const CONTRACT: &str = r#"name = "bench 3"
counts_per_rev = 2048
supply_v = 24.0
# optional: other columns and units of somebody else's log
[columns]            # name = "name in the file"
angle = "qm"
[units]              # angle: counts | deg | rad | rev | m ; voltage: V | duty ; current: A
angle = "rad"
[drive]
kind = "voltage"     # or "current"
[known]
resistance_ohm = { value = 1.2, tolerance = 0.05 }
kt_equals_kb = true
"#;

#[test]
fn the_contract_is_read() {
    let motor = MotorFile::parse(CONTRACT, "motor.toml").unwrap();
    assert_eq!(motor.name.as_deref(), Some("bench 3"));
    assert_eq!(
        (motor.counts_per_rev, motor.supply_v),
        (Some(2048.0), Some(24.0))
    );
    assert_eq!(
        motor.columns.get(servoid_io::channel::Channel::Angle),
        Some("qm")
    );
    assert_eq!(motor.units.angle, AngleUnit::Radians);
    assert_eq!(motor.drive, Drive::Voltage);
    assert_eq!(
        motor.known.resistance_ohm,
        Some(Fact {
            value: 1.2,
            tolerance: Some(0.05)
        })
    );
    assert!(motor.known.kt_equals_kb);
    let nothing = MotorFile::parse("", "motor.toml").unwrap();
    assert_eq!(
        nothing,
        MotorFile {
            source: Some("motor.toml".into()),
            ..MotorFile::default()
        }
    );
    assert_eq!(
        MotorFile::parse(&format!("\u{feff}{CONTRACT}"), "motor.toml").unwrap(),
        motor
    );
    assert_eq!(
        MotorFile::parse(&CONTRACT.replace('\n', "\r\n"), "motor.toml").unwrap(),
        motor
    );
}

/// Text, what the message must begin with, and what else it must say.
const BAD: &[(&str, &str, &str)] = &[
    // Keys.
    (
        "counts_per_rew = 4",
        "motor.toml:1:1: unknown key `counts_per_rew` at the top",
        "did you mean `counts_per_rev`?",
    ),
    (
        "a = 1\n[units]\nangel = \"rad\"",
        "motor.toml:3:1: unknown key `angel` in [units]",
        "did you mean `angle`?",
    ),
    (
        "[known]\nresistance = 1",
        "motor.toml:2:1: unknown key `resistance` in [known]",
        "`resistance_ohm`?",
    ),
    (
        "resistance_ohm = 1",
        "motor.toml:1:1: unknown key `resistance_ohm` at the top",
        "it belongs under [known]",
    ),
    (
        "[drive]\nsupply_v = 3",
        "motor.toml:2:1: unknown key `supply_v` in [drive]",
        "above the first [section]",
    ),
    (
        "[unit]\nangle = \"rad\"",
        "motor.toml:1:2: unknown key `unit` at the top",
        "did you mean `units`?",
    ),
    (
        "[known]\ninertia_kg_m2 = { valu = 1 }",
        "motor.toml:2:17: `inertia_kg_m2.value` is missing",
        "tolerance = 0.05",
    ),
    (
        "[known]\ninertia_kg_m2 = { value = 1, tol = 0.1 }",
        "motor.toml:2:30: unknown key `tol`",
        "`tolerance`?",
    ),
    (
        "x = 1",
        "motor.toml:1:1: unknown key `x` at the top",
        "known: `name`, `counts_per_rev`",
    ),
    // Types.
    (
        "counts_per_rev = \"2048\"",
        "motor.toml:1:18: `counts_per_rev` is a string here",
        "without quotes",
    ),
    (
        "supply_v = true",
        "motor.toml:1:12: `supply_v` is a boolean here",
        "decimal number",
    ),
    (
        "counts_per_rev = 0x800",
        "motor.toml:1:18: `counts_per_rev` is an integer here",
        "decimal number",
    ),
    (
        "name = 3",
        "motor.toml:1:8: `name` is an integer here",
        "in quotes",
    ),
    (
        "columns = 3",
        "motor.toml:1:11: `columns` is an integer here",
        "a table",
    ),
    (
        "known = []",
        "motor.toml:1:9: `known` is an array here",
        "a table",
    ),
    (
        "[known]\nkt_equals_kb = \"yes\"",
        "motor.toml:2:16: `kt_equals_kb` is a string here",
        "true or false",
    ),
    (
        "[columns]\nangle = 3",
        "motor.toml:2:9: `angle` is an integer here",
        "in quotes",
    ),
    (
        "[columns]\nangle = \" \"",
        "motor.toml:2:9: `angle` is empty",
        "leave the key out",
    ),
    (
        "[known]\nkt_n_m_a = [1, 2]",
        "motor.toml:2:12: `kt_n_m_a` is an array here",
        "number",
    ),
    // Values.
    (
        "counts_per_rev = 0",
        "motor.toml:1:18: `counts_per_rev` is 0; it must be greater than zero",
        "correct",
    ),
    (
        "supply_v = -24.0",
        "motor.toml:1:12: `supply_v` is -24; it must be greater than zero",
        "correct",
    ),
    (
        "supply_v = nan",
        "motor.toml:1:12: `supply_v` is nan, not a finite number",
        "correct",
    ),
    (
        "supply_v = -inf",
        "motor.toml:1:12: `supply_v` is -inf, not a finite number",
        "correct",
    ),
    (
        "supply_v = 1e999",
        "motor.toml:1:12: `supply_v` is 1e999, not a finite number",
        "correct",
    ),
    (
        "metres_per_rev = 0.0",
        "motor.toml:1:18: `metres_per_rev` is 0; it must be",
        "correct",
    ),
    (
        "[known]\ninductance_h = -1e-3",
        "motor.toml:2:16: `inductance_h` is -0.001; it must be",
        "correct",
    ),
    (
        "[known]\nkb_v_s_rad = { value = 0 }",
        "motor.toml:2:24: `value` is 0; it must be",
        "correct",
    ),
    (
        "[known]\nkb_v_s_rad = { value = 1, tolerance = 5 }",
        "motor.toml:2:39: tolerance is 5",
        "0.05 for 5 %",
    ),
    (
        "[known]\nkb_v_s_rad = { value = 1, tolerance = 0 }",
        "motor.toml:2:39: `tolerance` is 0",
        "leave the key out",
    ),
    // Words.
    (
        "[units]\nangle = \"grad\"",
        "motor.toml:2:9: `angle` is \"grad\"",
        "allowed: `counts`, `deg`, `rad`, `rev`, `m`",
    ),
    (
        "[units]\nvoltage = \"kV\"",
        "motor.toml:2:11: `voltage` is \"kV\"",
        "allowed: `V`, `mV`, `duty`, `percent`",
    ),
    (
        "[drive]\nkind = \"torque\"",
        "motor.toml:2:8: `kind` is \"torque\"",
        "allowed: `voltage`, `current`",
    ),
    // Contradictions.
    (
        "[units]\nvoltage = \"A\"",
        "motor.toml:2:11: the command is in \"A\", but the drive's kind is \"voltage\"",
        "kind = \"current\"",
    ),
    (
        "[drive]\nkind = \"current\"\n[units]\nvoltage = \"duty\"",
        "motor.toml:4:11: the command is in \"duty\", but the drive's kind is \"current\"",
        "a duty is a voltage",
    ),
    (
        "[known]\nkt_n_m_a = 0.06\nkb_v_s_rad = 0.07\nkt_equals_kb = true",
        "motor.toml:4:16: kt_equals_kb says",
        "kt_n_m_a is 0.06 and kb_v_s_rad is 0.07",
    ),
    // Syntax.
    ("counts_per_rev 2048", "motor.toml:1:", "this is not TOML"),
    ("name = \"open", "motor.toml:1:", "this is not TOML"),
    (
        "supply_v = 1\nsupply_v = 2",
        "motor.toml:2:1: this is not TOML: duplicate key",
        "toml.io",
    ),
    (
        "# ünïcödé\nname = \"ü\" x",
        "motor.toml:2:12",
        "this is not TOML",
    ),
];

#[test]
fn every_bad_motor_file_is_named_with_line_character_and_remedy() {
    for (text, begins, says) in BAD {
        let message = match MotorFile::parse(text, "motor.toml") {
            Ok(motor) => panic!("accepted {text:?} as {motor:?}"),
            Err(error) => error.to_string(),
        };
        assert!(
            message.starts_with(begins),
            "{text:?}\n  gave   {message}\n  wanted {begins}"
        );
        assert!(
            message.contains(says),
            "{text:?}\n  gave   {message}\n  without {says}"
        );
        assert_eq!(message.lines().count(), 1, "{message}");
    }
}

#[test]
fn tolerances_let_kt_and_kb_differ() {
    let near = "[known]\nkt_n_m_a = { value = 0.06, tolerance = 0.1 }\nkb_v_s_rad = 0.065\nkt_equals_kb = true";
    assert!(MotorFile::parse(near, "motor.toml").is_ok());
    let apart = "[known]\nkt_n_m_a = 0.06\nkb_v_s_rad = 0.07";
    assert!(MotorFile::parse(apart, "motor.toml").is_ok());
}

#[test]
fn the_file_beside_a_recording_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let recording = folder.path().join("rec.csv");
    assert!(MotorFile::find_beside(&recording).unwrap().is_none());
    std::fs::write(folder.path().join("motor.toml"), CONTRACT).unwrap();
    let found = MotorFile::find_beside(&recording).unwrap().unwrap();
    assert_eq!(found.counts_per_rev, Some(2048.0));
    std::fs::write(folder.path().join("motor.toml"), "counts_per_rev = 0").unwrap();
    let message = MotorFile::find_beside(&recording).unwrap_err().to_string();
    assert!(message.contains("motor.toml:1:18: "), "{message}");
}

#[test]
fn what_is_no_motor_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("motor.toml");
    let message = || MotorFile::read(&path).unwrap_err().to_string();
    assert!(message().contains("cannot be read"));
    std::fs::write(&path, b"name = \"\xff\"").unwrap();
    assert!(message().contains("is not UTF-8 text"));
    std::fs::write(&path, vec![b'#'; (1 << 20) + 1]).unwrap();
    assert!(message().contains("is larger than 1048576 bytes"));
    std::fs::remove_file(&path).unwrap();
    std::fs::create_dir(&path).unwrap();
    assert!(message().contains("is a folder"));
}
