//! One experiment as many loggers would have written it: columns, units and separators differ, the fit
//! must not.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::Value;

use crate::contract::number;
use crate::desk::Desk;

const COUNTS_PER_REV: f64 = 2000.0;
const SUPPLY_V: f64 = 12.0;
const PITCH_M: f64 = 0.0025;

/// How a logger writes.
struct Logger {
    header: &'static str,
    /// Cells of one sample from time in s, volts and counts.
    row: fn(f64, f64, f64) -> String,
    /// Sections of `motor.toml` that say so.
    file: &'static str,
    /// Flags that say the same.
    flags: &'static str,
}

const LOGGERS: &[Logger] = &[
    Logger {
        header: "t_s,voltage_v,angle_counts",
        row: |t, v, c| format!("{t},{v},{c}"),
        file: "",
        flags: "",
    },
    Logger {
        header: "angle_counts,note,voltage_v,t_s",
        row: |t, v, c| format!("{c},warm,{v},{t}"),
        file: "",
        flags: "",
    },
    Logger {
        header: "t_s;voltage_v;angle_counts",
        row: |t, v, c| format!("{t};{v};{c}"),
        file: "",
        flags: "",
    },
    Logger {
        header: "t_s\tvoltage_v\tangle_counts\r",
        row: |t, v, c| format!("{t}\t{v}\t{c}\r"),
        file: "",
        flags: "",
    },
    Logger {
        header: "clock,u,pos",
        row: |t, v, c| format!("{},{v},{}", 5.0 + t, c - 1e6),
        file: "[columns]\ntime = \"clock\"\nvoltage = \"u\"\nangle = \"pos\"\n",
        flags: "--column time=clock --column voltage=u --column angle=pos",
    },
    Logger {
        header: "t_s,voltage_v,pos",
        row: |t, v, c| format!("{t},{v},{}", c * 360.0 / COUNTS_PER_REV),
        file: "[columns]\nangle = \"pos\"\n[units]\nangle = \"deg\"\n",
        flags: "--column angle=pos --unit angle=deg",
    },
    Logger {
        header: "t_s,voltage_v,qm",
        row: |t, v, c| format!("{t},{v},{}", c * TAU / COUNTS_PER_REV),
        file: "[columns]\nangle = \"qm\"\n[units]\nangle = \"rad\"\n",
        flags: "--column angle=qm --unit angle=rad",
    },
    Logger {
        header: "t_s,voltage_v,turns",
        row: |t, v, c| format!("{t},{v},{}", c / COUNTS_PER_REV),
        file: "[columns]\nangle = \"turns\"\n[units]\nangle = \"rev\"\n",
        flags: "--column angle=turns --unit angle=rev",
    },
    Logger {
        header: "t_s,voltage_v,x",
        row: |t, v, c| format!("{t},{v},{}", c / COUNTS_PER_REV * PITCH_M),
        file: "[columns]\nangle = \"x\"\n[units]\nangle = \"m\"\n",
        flags: "--column angle=x --unit angle=m --metres-per-rev 0.0025",
    },
    Logger {
        header: "t_s,pwm,angle_counts",
        row: |t, v, c| format!("{t},{},{c}", v / SUPPLY_V),
        file: "[columns]\nvoltage = \"pwm\"\n[units]\nvoltage = \"duty\"\n",
        flags: "--column voltage=pwm --unit voltage=duty --supply-v 12",
    },
    Logger {
        header: "millis,voltage_v,angle_counts",
        row: |t, v, c| format!("{},{v},{c}", t * 1e3),
        file: "[columns]\ntime = \"millis\"\n[units]\ntime = \"ms\"\n",
        flags: "--column time=millis --unit time=ms",
    },
    Logger {
        header: "t_s,voltage_v,angle_counts",
        row: |t, v, c| format!("{t},{v},\n{t},,{c}"),
        file: "",
        flags: "",
    },
    Logger {
        header: "t_s,voltage_v,angle_counts",
        row: |t, v, c| format!("{t},,{c}\n{t},{v},"),
        file: "",
        flags: "",
    },
    Logger {
        header: "t_s,voltage_v,angle_counts",
        row: |t, v, c| {
            let warns = ((2.0 * t).fract() < 1e-6).then_some("WARN: lag=3,late=12,q=500\n");
            format!("{}{t},{v},{c}", warns.unwrap_or_default())
        },
        file: "",
        flags: "",
    },
    Logger {
        header: "t_s,voltage_v,angle_counts",
        row: |t, v, c| format!("{},{v},{c}", if (t - 1.0).abs() < 1e-9 { 1e12 } else { t }),
        file: "",
        flags: "",
    },
    Logger {
        header: "t_s,volts,Richtung,angle_counts",
        row: |t, v, c| {
            let way = match v {
                v if v > 0.0 => "vor",
                v if v < 0.0 => "zurueck",
                _ => "halt",
            };
            format!("{t},{},{way},{c}", v.abs())
        },
        file: "[columns]\nvoltage = \"volts\"\ndirection = \"Richtung\"\n",
        flags: "--column voltage=volts --column direction=Richtung",
    },
    Logger {
        header: "t_s,voltage_v,angle_counts,Endstufe",
        row: |t, v, c| format!("{t},{v},{c},EIN"),
        file: "[columns]\nenabled = \"Endstufe\"\n",
        flags: "--column enabled=Endstufe",
    },
    Logger {
        header: "rst:0x1 (POWERON_RESET),boot:0x13\nwhoami: bench v2.3",
        row: |t, v, c| format!("{t} {v} {c}"),
        file: "[columns]\ntime = \"1\"\nvoltage = \"2\"\nangle = \"3\"\n",
        flags: "--column time=1 --column voltage=2 --column angle=3",
    },
];

/// Time, volts and counts of a recording in the contract's columns.
fn samples(recording: &str) -> Vec<[f64; 3]> {
    let rows = recording
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    rows.map(|row| {
        let cells: Vec<f64> = row
            .split(',')
            .map(|cell| cell.parse().expect("a number"))
            .collect();
        cells.try_into().expect("three columns")
    })
    .collect()
}

fn assert_same_fit(fit: &Value, wanted: &Value, case: &str) {
    for (key, relative) in [
        ("identifiable.gain_rad_s_v", 1e-7),
        ("identifiable.a1_s", 1e-6),
        ("identifiable.a2_s2", 1e-4),
        ("rms_counts", 1e-4),
    ] {
        let (found, wanted) = (number(fit, key), number(wanted, key));
        assert!(
            (found / wanted - 1.0).abs() < relative,
            "{case}: {key} is {found}, not {wanted}"
        );
    }
}

#[test]
fn the_fit_does_not_depend_on_columns_units_or_separators() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --out rec.csv");
    let wanted = desk.json("fit rec.csv");
    let samples = samples(&desk.read("rec.csv"));
    for logger in LOGGERS {
        let mut log = format!("{}\n", logger.header);
        for &[t, v, c] in &samples {
            writeln!(log, "{}", (logger.row)(t, v, c)).expect("a string takes it");
        }
        desk.write("file/log.csv", &log);
        desk.write(
            "file/motor.toml",
            format!(
                "counts_per_rev = {COUNTS_PER_REV}\nsupply_v = {SUPPLY_V}\nmetres_per_rev = {PITCH_M}\n{}",
                logger.file
            ),
        );
        assert_same_fit(&desk.json("fit file/log.csv"), &wanted, logger.file);
        desk.write("flags/log.csv", &log);
        let line = format!("fit flags/log.csv --counts-per-rev 2000 {}", logger.flags);
        assert_same_fit(&desk.json(&line), &wanted, logger.flags);
    }
}

#[test]
fn a_flag_goes_before_the_file_and_a_named_file_before_the_one_beside() {
    let desk = Desk::with_recording();
    let gain = |line: &str| number(&desk.json(line), "identifiable.gain_rad_s_v");
    let beside = gain("fit rec.csv");
    desk.write("half.toml", "counts_per_rev = 1000\n");
    let ratio = |line: &str| gain(line) / beside;
    assert!((ratio("fit rec.csv --motor half.toml") - 2.0).abs() < 1e-9);
    assert!((ratio("fit rec.csv --counts-per-rev 500") - 4.0).abs() < 1e-9);
    assert!((ratio("fit rec.csv --motor half.toml --counts-per-rev 500") - 4.0).abs() < 1e-9);
}

#[test]
fn radians_to_six_digits_are_as_good_as_counts() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --out rec.csv");
    let wanted = number(&desk.json("fit rec.csv"), "identifiable.gain_rad_s_v");
    let mut log = String::from("t_s,voltage_v,q\n");
    for [t, v, c] in samples(&desk.read("rec.csv")) {
        writeln!(log, "{t:.3},{v:.4},{:.6}", c * TAU / COUNTS_PER_REV).expect("a string takes it");
    }
    desk.write("log.csv", log);
    let fit = desk.json("fit log.csv --column angle=q --unit angle=rad");
    assert!(
        (number(&fit, "identifiable.gain_rad_s_v") / wanted - 1.0).abs() < 1e-6,
        "{fit:#}"
    );
    assert!(
        (0.26..0.32).contains(&number(&fit, "rms_counts")),
        "{fit:#}"
    );
}

#[test]
fn a_counter_that_is_zeroed_at_rest_before_a_run_leaves_the_fit_as_it_is() {
    let desk = Desk::new();
    desk.done("simulate --seconds 4 --out rec.csv");
    let wanted = desk.json("fit rec.csv");
    let mut log = "t_s,voltage_v,angle_counts\n".to_owned();
    let rest = (0..100).map(|k| [0.001 * f64::from(k) - 0.1, 0.0, 54_321.0]);
    for [t, v, c] in rest.chain(samples(&desk.read("rec.csv"))) {
        writeln!(log, "{t},{v},{c}").expect("a string takes it");
    }
    desk.write("rested.csv", &log);
    assert_same_fit(
        &desk.json("fit rested.csv --counts-per-rev 2000"),
        &wanted,
        "rested",
    );
}
