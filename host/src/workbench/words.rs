//! What was written for a terminal, in the words of a page: its fields stand where flags would.

/// What a flag would do, and how the page says it. The longer pieces come first.
const IN_PLACE_OF: [(&str, &str); 25] = [
    (
        " under [units] in what is said of the motor: angle = \"rad\" (or deg, rev, m)",
        " beside the column (for metres, drop a motor.toml with the file)",
    ),
    (
        "counts_per_rev is not known; add `counts_per_rev = 2048` (your encoder's lines times 4) at the top of what is \
         said of the motor, or give --counts-per-rev",
        "the encoder's counts a revolution are not known; fill them in (its lines times 4)",
    ),
    (
        "add `supply_v = 24.0` (your supply) at the top of what is said of the motor, or give --supply-v",
        "fill it in",
    ),
    (
        "add `supply_v = 7.4` (your supply) at the top of what is said of the motor or `limit_v = 7.4` under [drive], or give \
         --supply-v",
        "fill in the supply, or drop a motor.toml with limit_v under [drive]",
    ),
    (
        "give the gain (gain_v_per_rad = 8.4 under [drive] in what is said of the motor, or --loop gain_v_per_rad=8.4)",
        "drop a motor.toml with the gain (gain_v_per_rad = 8.4 under [drive])",
    ),
    (
        "give --loop gain_v_per_rad=",
        "write under [drive] in a motor.toml gain_v_per_rad = ",
    ),
    (
        "say that of the target with --unit target=deg (or counts, rad, rev), or under [units] in motor.toml",
        "say that of the target under [units] in a motor.toml: target = \"deg\" (or counts, rad, rev)",
    ),
    (
        "fit again with --known resistance_ohm=… (an ohmmeter) and --kt-equals-kb or --known kt_n_m_a=… (a datasheet), or with \
         a current column",
        "load the recording again with a motor.toml that says [known] resistance_ohm = … (an ohmmeter) and kt_equals_kb = \
         true or kt_n_m_a = … (a datasheet), or with a current column",
    ),
    (
        "fit again with --known resistance_ohm=…",
        "load the recording again with its armature resistance",
    ),
    ("fit again with --with coulomb", "add coulomb"),
    (
        "a search that converges (--algorithm lm)",
        "a search that converges (lm)",
    ),
    (
        "raise --budget, or use --algorithm lm",
        "search with lm, or with `servoid fit` and a larger budget",
    ),
    (
        "widen it with `servoid fit --bounds`",
        "`servoid fit` takes wider bounds in a terminal",
    ),
    ("(try --with)", "(look for what would explain more)"),
    (
        "(try --window)",
        "(`servoid fit` takes windows in a terminal)",
    ),
    ("use --integrator exact", "use the exact step"),
    (
        "say --unit time=ms (or us), or time = \"ms\" under [units] in motor.toml",
        "choose ms (or us) beside its column",
    ),
    (
        "say --unit time=ms (or us)",
        "choose ms (or us) beside its column",
    ),
    (
        "give another with --validate",
        "load a second recording, never fitted",
    ),
    (
        "Run it again with a larger --budget for a verdict",
        "In a terminal, servoid diagnose takes a larger budget",
    ),
    (
        "run it again with a larger --budget",
        "in a terminal, servoid diagnose takes a larger budget",
    ),
    (
        "write this diagnosis with --json diagnosis.json, then: ",
        "export this diagnosis as diagnosis.json, then in a terminal: ",
    ),
    (
        "; give another --sample",
        "; `servoid export` takes another sample interval in a terminal",
    ),
    (
        "Say what is known with --known",
        "Say what is known in a motor.toml",
    ),
    ("what is said of the motor:", "motor.toml:"),
];
/// Where the message of columns that are missing turns to the motor file and to flags.
const OF_COLUMNS: &str = ". Say in ";

/// The text as the page says it.
pub(super) fn on_the_page(text: &str) -> String {
    let mut text = text.to_owned();
    if text.contains("[columns]")
        && let Some(end) = text.find(OF_COLUMNS)
    {
        text.truncate(end);
        text += "; choose which column is which";
    }
    for (terminal, page) in IN_PLACE_OF {
        text = text.replace(terminal, page);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::loaded::MOTOR;
    use super::on_the_page;
    use servoid_io::input::{MotorFile, read_recording_from};

    #[test]
    fn a_page_sends_nobody_to_flags_for_what_its_fields_ask() {
        let rows = "0,1,0\n0.001,1,3\n0.002,1,7\n";
        for (header, motor, says) in [
            ("a,b,c", "counts_per_rev = 2000", "which column is which"),
            ("t_s,voltage_v,angle_counts", "", "fill them in"),
            (
                "t_s,duty,angle_counts",
                "counts_per_rev = 2000\n[columns]\nvoltage = \"duty\"\n[units]\nvoltage = \"duty\"",
                "fill it in",
            ),
            (
                "t_s,target_counts,angle_counts",
                "counts_per_rev = 2000\n[drive]\nkind = \"position\"",
                "fill in the supply",
            ),
            (
                "t_s,target_counts,angle_counts",
                "counts_per_rev = 2000\nsupply_v = 12\n[drive]\nkind = \"position\"",
                "drop a motor.toml with the gain",
            ),
        ] {
            let motor = MotorFile::parse(motor, MOTOR).expect("a motor file");
            let csv = format!("{header}\n{rows}");
            let error = read_recording_from(csv.as_bytes(), "x.csv", &motor).expect_err(header);
            let said = on_the_page(&error.to_string());
            assert!(said.contains(says) && !said.contains("--"), "{said}");
        }
        let error = MotorFile::parse("counts_per_rev = -1", MOTOR).expect_err("a negative number");
        let said = on_the_page(&error.to_string());
        assert!(said.starts_with("motor.toml:1:"), "{said}");
        let csv = "t_s,voltage_v,angle_counts\n0,1,0.5\n0.001,1,3\n";
        let motor = MotorFile::parse("counts_per_rev = 2000", MOTOR).expect("a motor file");
        let error = read_recording_from(csv.as_bytes(), "x.csv", &motor).expect_err("a fraction");
        let said = on_the_page(&error.to_string());
        assert!(said.contains("beside the column"), "{said}");
    }
}
