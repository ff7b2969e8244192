//! Flags that must be refused: exit code 2, the flag's name, and what it takes.

use crate::desk::Desk;

/// Flags of `fit rec.csv`, and what the message must say.
const FIT: &[(&str, &[&str])] = &[
    ("--with coulom", &["--with", "coulomb"]),
    ("--with coulomb,coulomb", &["--with", "twice"]),
    ("--algorithm psoo", &["--algorithm", "pso"]),
    ("--algorithm=", &["--algorithm"]),
    ("--cost squred", &["--cost", "squared"]),
    ("--integrator rk4", &["--integrator", "exact", "euler"]),
    ("--window nan", &["--window", "positive"]),
    ("--window -1", &["--window", "positive"]),
    ("--window 0", &["--window", "positive"]),
    ("--window inf", &["--window", "positive"]),
    ("--substeps 0", &["--substeps"]),
    ("--budget 0", &["--budget"]),
    ("--budget 1e3", &["--budget"]),
    ("--seed -1", &["--seed"]),
    ("--bounds gain", &["--bounds", "gain=10:100"]),
    ("--bounds gain=1", &["--bounds"]),
    ("--bounds gain=10:1", &["--bounds", "crossed"]),
    ("--bounds gain=-1:10", &["--bounds", "negative"]),
    ("--bounds gain=0:10", &["--bounds", "above zero"]),
    ("--bounds gain=nan:10", &["--bounds", "finite"]),
    ("--bounds gain=1:inf", &["--bounds", "finite"]),
    ("--bounds gian=1:10", &["--bounds", "`gain`"]),
    (
        "--counts-per-rev 0",
        &["servoid: --counts-per-rev ", "greater than zero"],
    ),
    (
        "--counts-per-rev -5",
        &["servoid: --counts-per-rev ", "greater than zero"],
    ),
    (
        "--counts-per-rev nan",
        &["servoid: --counts-per-rev NaN: ", "finite"],
    ),
    ("--supply-v inf", &["servoid: --supply-v inf: ", "finite"]),
    (
        "--known resistance_ohm=abc",
        &["servoid: --known resistance_ohm=abc: ", "not a number"],
    ),
    (
        "--known resistance_ohm=nan",
        &["servoid: --known resistance_ohm=nan: "],
    ),
    (
        "--known resistance_ohm=1 --known resistance_ohm=2",
        &["--known resistance_ohm=2", "before"],
    ),
    ("--unit voltage=A", &["servoid: --unit voltage=A: "]),
    ("--counts-per-rev many", &["--counts-per-rev", "many"]),
    (
        "--supply-v -12",
        &["servoid: --supply-v -12: ", "greater than zero"],
    ),
    ("--column angle", &["--column", "angle=name"]),
    (
        "--column angel=x",
        &["servoid: --column angel=x: ", "`angle`"],
    ),
    (
        "--unit angle=grad",
        &["servoid: --unit angle=grad: ", "`deg`"],
    ),
    (
        "--drive torque",
        &["servoid: --drive torque: ", "`current`"],
    ),
    (
        "--known resistance=1",
        &["servoid: --known resistance=1: ", "`resistance_ohm`"],
    ),
    (
        "--known resistance_ohm=-1",
        &["servoid: --known resistance_ohm=-1: ", "greater than zero"],
    ),
    (
        "--known resistance_ohm=1~2",
        &["servoid: --known resistance_ohm=1~2: ", "0.05"],
    ),
    ("--no-such-flag", &["--no-such-flag"]),
];

/// Flags of `simulate --out new.csv`, and what the message must say.
const SIMULATE: &[(&str, &[&str])] = &[
    ("--machine gearmoter", &["--machine", "`gearmotor`"]),
    ("--excite stepp", &["--excite", "`step`"]),
    ("--hide colomb", &["--hide", "`coulomb`"]),
    ("--hide coulomb:torqe=1", &["--hide", "`torque`"]),
    ("--hide coulomb:torque=much", &["--hide", "not a number"]),
    ("--hide coulomb:torque=nan", &["--hide", "torque"]),
    ("--hide coulomb:torque=-1", &["--hide", "torque"]),
    ("--sample 0", &["--sample", "positive"]),
    ("--sample -1", &["--sample", "positive"]),
    ("--sample nan", &["--sample", "positive"]),
    ("--sample 1e-9", &["samples"]),
    ("--seconds inf", &["--seconds", "samples"]),
    ("--seconds nan", &["--seconds", "samples"]),
    ("--seconds 0", &["--seconds", "samples"]),
    ("--seconds -3", &["--seconds", "samples"]),
    ("--seconds 1e9", &["--seconds", "samples"]),
    ("--amplitude 2", &["--amplitude", "at most 1"]),
    ("--amplitude 0", &["--amplitude", "above 0"]),
    ("--amplitude -1", &["--amplitude", "above 0"]),
    ("--amplitude nan", &["--amplitude", "above 0"]),
    ("--counts-per-rev -1", &["--counts-per-rev"]),
    ("--counts-per-rev 1.5", &["--counts-per-rev"]),
    ("--seed x", &["--seed"]),
];

/// Whole lines, and what the message must say.
const LINES: &[(&str, &[&str])] = &[
    ("fitt rec.csv", &["fitt"]),
    ("fit", &["<RECORDING>"]),
    ("simulate", &["--out"]),
    (
        "compare rec.csv --algorithm lm,psoo",
        &["--algorithm", "pso"],
    ),
    ("compare rec.csv --seeds 0", &["--seeds"]),
    ("compare rec.csv --seeds -1", &["--seeds"]),
    ("compare rec.csv --budget 0", &["--budget"]),
    ("paper --population 1", &["--population"]),
    ("paper --iterations 0", &["--iterations"]),
    ("paper --seeds 0", &["--seeds"]),
    ("paper --seconds 0", &["--seconds", "samples"]),
    ("paper --seconds nan", &["--seconds", "samples"]),
    ("paper --sample -1", &["--sample", "samples"]),
    ("paper --bounds 1", &["--bounds"]),
    ("paper --bounds 1:0", &["--bounds", "crossed"]),
    ("paper --bounds 1:1", &["--bounds", "equal"]),
    ("paper --bounds -1:1", &["--bounds", "above zero"]),
    ("paper --plots missing", &["--plots", "missing"]),
    ("completions bsh", &["bash"]),
];

#[test]
fn bad_flags_are_wrong_use() {
    let desk = Desk::with_recording();
    for (flags, says) in FIT {
        desk.refused(
            &format!("fit rec.csv --json out.json --plot out.svg {flags}"),
            2,
            says,
        );
    }
    for (flags, says) in SIMULATE {
        desk.refused(
            &format!("simulate --out new.csv --json out.json {flags}"),
            2,
            says,
        );
    }
    for (line, says) in LINES {
        desk.refused(&format!("{line} --json out.json"), 2, says);
    }
}

/// What the bench itself refuses.
#[test]
fn settings_that_no_bench_has_are_refused() {
    let desk = Desk::new();
    for (flags, says) in [
        ("--jitter nan", "--jitter NaN"),
        ("--jitter -1", "--jitter -1"),
        ("--jitter 1e-3", "half the sample interval"),
        ("--counts-per-rev 0", "--counts-per-rev 0: needs at least 1"),
        ("--counts-per-rev 4000000000", "32-bit counter"),
        ("--current-noise -1", "--current-noise -1"),
        ("--substep-hz 10", "--substep-hz 10"),
        ("--sample 10", "--sample 10: leaves"),
        ("--hide coulomb --hide coulomb", "twice"),
        ("--hide coulomb:strength=1e300 --hide coulomb", "--hide"),
        ("--hide coulomb:", "nothing follows the colon"),
        ("--hide coulomb:,", "nothing follows the colon"),
    ] {
        let flag = flags.split(' ').next().expect("a flag");
        desk.refused(&format!("simulate --out new.csv {flags}"), 2, &[flag, says]);
    }
}

#[test]
fn no_verb_at_all_shows_the_help() {
    let outcome = Desk::new().run("");
    assert_eq!(outcome.code, Some(2), "{outcome}");
    assert!(outcome.stderr.contains("Usage: servoid"), "{outcome}");
}
