//! Rows as real loggers write them: each log below is the same motion with one fault of the kind that loggers have, and gives the same samples
//! with a remark, or is refused with its line.

use servoid_io::channel::Channel;
use servoid_io::input::{MotorFile, Reading, read_recordings, survey};
use servoid_io::recording::Recording;
use std::fs;

const SAMPLES: usize = 1200;
const COUNTS: f64 = 2048.0;
const STEP_S: f64 = 0.002;

/// A motor under steps of its command: volts and counts.
fn motion() -> Vec<(f64, f64)> {
    let (mut angle, mut speed, mut volts) = (97.4f64, 0.0f64, 0.0f64);
    let rows = (0..SAMPLES).map(|k| {
        if k % 53 == 20 {
            volts = [6.0, -9.0, 3.0, 0.0, -4.5, 10.0][k / 53 % 6];
        }
        let row = (volts, angle.floor());
        speed += STEP_S / 0.09 * (18.0 * volts - speed);
        angle += speed * STEP_S / std::f64::consts::TAU * COUNTS;
        row
    });
    rows.collect()
}

fn motor() -> MotorFile {
    MotorFile {
        counts_per_rev: Some(COUNTS),
        supply_v: Some(12.0),
        ..MotorFile::default()
    }
}

fn read(text: impl AsRef<[u8]>) -> Result<Reading, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.csv");
    fs::write(&path, text.as_ref()).expect("written");
    read_recordings(&path, &motor()).map_err(|error| error.to_string())
}

/// A log with a header and rows of time (s), volts and counts.
fn log(header: &str, row: impl Fn(usize, f64, f64, f64) -> String) -> String {
    let mut text = format!("{header}\n");
    for (k, (volts, counts)) in motion().into_iter().enumerate() {
        text += &row(k, STEP_S * k as f64, volts, counts);
        text.push('\n');
    }
    text
}

const PLAIN: &str = "t_s,voltage_v,angle_counts";

fn plain(_: usize, t: f64, volts: f64, counts: f64) -> String {
    format!("{t:.3},{volts},{counts}")
}

fn only(reading: &Reading) -> &Recording {
    let [only] = &reading.recordings[..] else {
        panic!("{} recordings", reading.recordings.len());
    };
    only
}

fn same(own: &Recording, usual: &Recording) {
    assert_eq!(own.len(), usual.len());
    let start = own.counts[0] - usual.counts[0];
    for k in 0..own.len() {
        assert_eq!(own.counts[k] - usual.counts[k], start, "sample {k}");
        assert!(
            (own.command[k] - usual.command[k]).abs() < 0.05,
            "sample {k}"
        );
        let times = (own.time_s[k] - own.time_s[0]) - (usual.time_s[k] - usual.time_s[0]);
        assert!(times.abs() < 1e-5, "sample {k}: {times}");
    }
}

#[test]
fn faults_of_loggers_are_undone_and_said() {
    let usual = read(log(PLAIN, plain)).expect("the plain log");
    assert_eq!(usual.notes, Vec::<String>::new());
    let usual = only(&usual).clone();
    let least = usual.counts.iter().copied().fold(0.0, f64::min);
    assert!(
        usual.counts.iter().any(|x| x - least > 2.0 * COUNTS),
        "it turns"
    );
    let wrap = |x: f64| x.rem_euclid(COUNTS);
    let logs: Vec<(&str, String)> = vec![
        ("wraps", log(PLAIN, |k, t, u, n| plain(k, t, u, wrap(n)))),
        (
            "wraps",
            log("t_s,voltage_v,angle_deg", |_, t, u, n| {
                format!("{t:.3},{u},{:.4}", wrap(n) / COUNTS * 360.0)
            }),
        ),
        (
            "read time from `zeit` (ms)",
            log("zeit,spannung,winkel", |k, _, u, n| {
                format!("{},{u},{n}", 2 * k)
            }),
        ),
        (
            "spread evenly",
            log("time_ms,voltage_v,angle_counts", |_, t, u, n| {
                // Four rows to two stamps.
                format!("{},{u},{n}", ((t * 1e3 / 4.0).floor() * 4.0) as i64)
            }),
        ),
        (
            "runs over",
            log("time_us,voltage_v,angle_counts", |_, t, u, n| {
                let stamp = (4_294_000_000 + (t * 1e6) as u64) % (1 << 32);
                format!("{stamp},{u},{n}")
            }),
        ),
        (
            "of text among the rows",
            log(PLAIN, |k, t, u, n| {
                let said = if k == 500 {
                    "MOT: target 2.0\nok\n"
                } else {
                    ""
                };
                format!("{said}{}", plain(k, t, u, n))
            }),
        ),
        (
            "backwards",
            log("millis,pwm,dir,ticks", |_, t, u, n| {
                let word = if u < 0.0 { "CCW" } else { "CW" };
                format!(
                    "{},{},{word},{n}",
                    (t * 1e3).round(),
                    (u.abs() / 12.0 * 255.0).round()
                )
            }),
        ),
        (
            "supply voltage from `battery_v`",
            log("t_s,duty_cycle,battery_v,angle_counts", |k, t, u, n| {
                let battery = 13.0 - 0.001 * k as f64;
                format!("{t:.3},{},{battery},{n}", u / battery)
            }),
        ),
    ];
    for (says, text) in logs {
        let reading = read(&text).unwrap_or_else(|error| panic!("{says}: {error}"));
        assert!(
            reading.notes.iter().any(|note| note.contains(says)),
            "{says}: {:?}",
            reading.notes
        );
        let own = only(&reading);
        same(own, &usual);
    }
}

#[test]
fn what_is_before_and_behind_a_counter_that_is_set_anew_are_two_parts() {
    for by in [-460.0, -60_000.0, 5000.0] {
        let text = log(PLAIN, |k, t, u, n| {
            plain(k, t, u, if k < 700 { n } else { n + by })
        });
        let reading = read(&text).expect("read");
        let lengths: Vec<usize> = reading.recordings.iter().map(Recording::len).collect();
        assert_eq!(lengths, [700, SAMPLES - 700], "{by}");
        assert!(
            reading.notes.iter().any(|note| note.contains("jumps by")),
            "{:?}",
            reading.notes
        );
    }
}

#[test]
fn one_absurd_time_is_put_right_and_many_are_refused() {
    let text = |absurd: &dyn Fn(usize) -> bool| {
        log(PLAIN, |k, t, u, n| {
            plain(k, if absurd(k) { 4.2e15 } else { t }, u, n)
        })
    };
    let reading = read(text(&|k| k == 600)).expect("read");
    let wanted = read(text(&|_| false)).expect("read");
    assert_eq!(only(&reading).command, only(&wanted).command);
    assert!((only(&reading).time_s[600] - only(&wanted).time_s[600]).abs() < 1e-9);
    assert!(reading.notes[0].contains("line 602"), "{:?}", reading.notes);
    let error = read(text(&|k| k % 20 == 7)).expect_err("refused");
    assert!(error.contains("log.csv:9"), "{error}");
}

#[test]
fn rows_without_numbers_keep_their_commands() {
    let text = log(PLAIN, |k, t, u, n| match k {
        300..=380 => format!("{t:.3},{u},"),
        k if k % 17 == 5 => format!("{t:.3},{u},nan"),
        k if k % 29 == 3 => format!("{t:.3},,{n}"),
        _ => plain(k, t, u, n),
    });
    let reading = read(&text).expect("read");
    // The long gap parts it.
    assert_eq!(reading.recordings.len(), 2);
    for says in ["have no angle", "have no command"] {
        assert!(
            reading.notes.iter().any(|note| note.contains(says)),
            "{:?}",
            reading.notes
        );
    }
}

#[test]
fn motors_that_take_turns_are_refused_with_the_selection() {
    let text = log("t_s,motor_id,voltage_v,angle_counts", |_, t, u, n| {
        format!("{t:.4},1,{u},{n}\n{:.4},2,{},{}", t + 0.001, -u, -n)
    });
    let error = read(&text).expect_err("refused");
    assert!(
        error.contains("motor_id") && error.contains("--select motor_id=1"),
        "{error}"
    );
}

#[test]
fn a_german_export_is_read_with_its_preamble_and_units() {
    let comma = |x: f64| format!("{x:.4}").replace('.', ",");
    let mut bytes = b"Versuch 12;;\nDatum;04.11.2026;\n\n".to_vec();
    let rows = log("Zeit;Spannung;Winkel\n[s];[V];[DEGREE]", |_, t, u, n| {
        format!("{};{};{}", comma(t), comma(u), comma(n / COUNTS * 360.0))
    });
    // Windows-1252 has the degree in one byte.
    for part in rows.split_inclusive("DEGREE") {
        bytes.extend(part.trim_end_matches("DEGREE").bytes());
        if part.ends_with("DEGREE") {
            bytes.push(0xb0);
        }
    }
    let reading = read(&bytes).expect("read");
    assert_eq!(only(&reading).len(), SAMPLES);
    assert!(only(&reading).quantised);
    for says in ["Windows-1252", "but units", "angle from `Winkel` (deg)"] {
        assert!(
            reading.notes.iter().any(|note| note.contains(says)),
            "{says}: {:?}",
            reading.notes
        );
    }
}

/// Headers as people write them; of each the columns of time, command and angle, and the units that `[units]` calls otherwise than usual.
const HEADERS: &[(&str, [&str; 3], [&str; 3])] = &[
    (
        "time,u,theta_rad",
        ["time", "u", "theta_rad"],
        ["", "", "rad"],
    ),
    (
        "Timestamp [ms],Duty,Position (deg)",
        ["Timestamp [ms]", "Duty", "Position (deg)"],
        ["ms", "duty", "deg"],
    ),
    (
        "t,target_theta,target_alpha,theta,alpha,control_output,feedforward,plant_input,saturation",
        ["t", "plant_input", "theta"],
        ["", "", ""],
    ),
    (
        "t_ms,bus_voltage,motor_voltage,pos_ref,pos,iq_current",
        ["t_ms", "motor_voltage", "pos"],
        ["ms", "", ""],
    ),
    (
        "millis,pwm,ticks,enable",
        ["millis", "pwm", "ticks"],
        ["ms", "duty", ""],
    ),
    (
        "tme_s,voltge_v,angle_count",
        ["tme_s", "voltge_v", "angle_count"],
        ["", "", ""],
    ),
    (
        "Zeit [s],Spannung [mV],Winkel [Grad],Strom",
        ["Zeit [s]", "Spannung [mV]", "Winkel [Grad]"],
        ["", "mV", "deg"],
    ),
    (
        "temps,tension,position (tr),courant",
        ["temps", "tension", "position (tr)"],
        ["", "", "rev"],
    ),
    (
        "tiempo (ms),voltaje,ángulo (grados)",
        ["tiempo (ms)", "voltaje", "ángulo (grados)"],
        ["ms", "", "deg"],
    ),
    ("时间,电压,角度", ["时间", "电压", "角度"], ["", "", ""]),
];

#[test]
fn columns_are_told_by_the_names_that_people_use() {
    let per = |unit: &str| match unit {
        "ms" | "mV" => 1e3,
        "duty" => 1.0 / 12.0,
        "deg" => 360.0 / COUNTS,
        "rad" => std::f64::consts::TAU / COUNTS,
        "rev" => 1.0 / COUNTS,
        _ => 1.0,
    };
    for (header, columns, units) in HEADERS {
        let text = log(header, |_, t, volts, counts| {
            let cells = header.split(',').map(|name| {
                let place = columns.iter().position(|column| *column == name);
                let value = place.map_or(0.0, |k| [t, volts, counts][k] * per(units[k]));
                format!("{value:.5}")
            });
            cells.collect::<Vec<_>>().join(",")
        });
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("log.csv");
        fs::write(&path, text).expect("written");
        let found = survey(&path, &motor(), None, &|_| ()).expect("a survey");
        let proposed = [Channel::Time, Channel::Command, Channel::Angle].map(|channel| {
            let mut all = found.proposal.columns.iter();
            let one = all.find(|one| one.channel == channel);
            one.map(|one| (one.column.as_str(), one.unit.unwrap_or_default()))
        });
        let wanted = [0, 1, 2].map(|k| Some((columns[k], units[k])));
        assert_eq!(proposed, wanted, "{header}");
    }
}
