//! Laws of the readers and writers: no input makes them panic, whatever they accept keeps the promises of its
//! type, and what is written is read back the same. (proptest prints the seed of a failure.)

use proptest::prelude::*;
use servoid_io::channel::{Channel, Measured, PerMeasured, Series};
use servoid_io::input::{
    AngleUnit, CommandUnit, Fact, Known, LogPart, MotorFile, Reversed, Selection, TimeUnit, Units,
};
use servoid_io::input::{Columns, read_recording_from};
use servoid_io::output::{write_csv, write_recording};
use servoid_io::position_loop::LoopSettings;
use servoid_io::recording::{Drive, Recording};

fn check_promises(recording: &Recording) {
    let n = recording.len();
    assert!(n >= 2);
    assert_eq!((recording.command.len(), recording.counts.len()), (n, n));
    assert!(
        recording
            .measured
            .told()
            .all(|(_, values)| values.len() == n && values.iter().all(|x| x.is_finite()))
    );
    assert!(
        recording
            .enabled
            .as_ref()
            .is_none_or(|enabled| enabled.len() == n)
    );
    assert!(recording.time_s.windows(2).all(|pair| pair[0] < pair[1]));
    let columns = [&recording.time_s, &recording.command, &recording.counts];
    assert!(columns.into_iter().flatten().all(|x| x.is_finite()));
    assert!(recording.counts.iter().all(|x| x.abs() <= 2f64.powi(31)));
    assert!(!recording.quantised || recording.counts.iter().all(|x| x.fract() == 0.0));
    let targets = recording.position.as_ref().map(|p| &p.target_counts);
    assert!(targets.is_none_or(|t| t.len() == n && t.iter().all(|x| x.is_finite())));
    assert!(recording.counts_per_rev.is_finite() && recording.counts_per_rev > 0.0);
}

/// Of all ways to read, an input is read in one of so many: over all inputs of a law each way has its turn often.
const TURNS: usize = 8;

/// Reads with every [`TURNS`]th kind of unit and checks what is accepted.
fn read_in_turn(bytes: &[u8], turn: usize) {
    for motor in ways().skip(turn).step_by(TURNS) {
        read_one_way(bytes, &motor);
    }
}

/// Every kind of unit of a voltage drive and of a position drive.
fn ways() -> impl Iterator<Item = MotorFile> {
    let plain = || MotorFile {
        counts_per_rev: Some(2048.0),
        supply_v: Some(24.0),
        metres_per_rev: Some(0.0025),
        ..MotorFile::default()
    };
    let angles = AngleUnit::ALL.iter().chain(AngleUnit::SPEEDS);
    let voltage_drives = angles.flat_map(move |(_, angle)| {
        CommandUnit::ALL.iter().map(move |(_, voltage)| MotorFile {
            units: Units {
                angle: *angle,
                voltage: *voltage,
                ..Units::default()
            },
            ..plain()
        })
    });
    let position_drives = AngleUnit::ALL.iter().flat_map(move |(_, angle)| {
        [None, Some(3.0)].map(|gain| {
            let mut motor = MotorFile {
                units: Units {
                    target: Some(*angle),
                    ..Units::default()
                },
                position: Some(LoopSettings {
                    gain_v_per_rad: gain,
                    damping_v_s_per_rad: Some(0.1),
                    rate_hz: Some(700.0),
                    ..LoopSettings::default()
                }),
                ..plain()
            };
            let command = Some("voltage_v".into());
            motor.columns.set(Channel::Command, command);
            motor
        })
    });
    voltage_drives.chain(position_drives)
}

fn read_one_way(bytes: &[u8], motor: &MotorFile) {
    match read_recording_from(bytes, "rec.csv", motor) {
        Ok(recording) => {
            check_promises(&recording);
            // Any verdict is fine; it must be one.
            drop(recording.check_excited());
        }
        Err(error) => assert!(error.to_string().starts_with("rec.csv:")),
    }
}

/// Cells that a reader stumbles over, and sound ones.
fn cell() -> impl Strategy<Value = String> {
    prop_oneof![
        6 => any::<i16>().prop_map(|x| x.to_string()),
        3 => any::<f64>().prop_map(|x| x.to_string()),
        1 => prop::sample::select(vec!["", " ", "nan", "-inf", "1e999", "x", "\"", "\"1\"", "0x10", "#", "\u{feff}1", "1_0", "ü"])
            .prop_map(String::from),
    ]
}

fn csv_like() -> impl Strategy<Value = String> {
    let row = prop_oneof![
        8 => (0..1000u32, cell(), cell(), cell(), 0..2u8).prop_map(|(t, v, a, i, e)| format!("{t},{v},{a},{i},{e}")),
        1 => prop::collection::vec(cell(), 0..6).prop_map(|cells| cells.join(",")),
        1 => Just("# comment".to_string()),
    ];
    let header = prop_oneof![
        4 => Just("t_s,voltage_v,angle_counts,current_a,enabled".to_string()),
        1 => Just("\u{feff}t_s, voltage_V ,\"angle_rad\",current_a,enabled".to_string()),
        1 => prop::collection::vec("[a-z_]{0,8}", 0..6).prop_map(|names| names.join(",")),
    ];
    let end = prop::sample::select(vec!["\n", "\r\n", "\r", "\n\n"]);
    (header, prop::collection::vec(row, 0..8), end)
        .prop_map(|(header, rows, end)| format!("{header}{end}{}", rows.join(end)))
}

fn toml_like() -> impl Strategy<Value = String> {
    let key = prop::sample::select(vec![
        "name",
        "counts_per_rev",
        "supply_v",
        "[columns]\nangle",
        "[units]\nangle",
        "[drive]\nkind",
        "[known]\nkt_n_m_a",
        "[known]\nkt_equals_kb",
        "known.kb_v_s_rad",
        "ü",
        "[units",
        "\"\"",
    ]);
    let value = prop_oneof![
        any::<f64>().prop_map(|x| format!("{x:?}")),
        any::<i64>().prop_map(|x| x.to_string()),
        "\"[a-z]{0,5}\"",
        "[a-z\"{}\\[\\]=.,#\n ]{0,12}",
        Just("{ value = 1.2, tolerance = 0.05 }".to_string()),
        Just("\"rad\"".to_string()),
        Just("true".to_string()),
    ];
    prop::collection::vec((key, value), 0..6).prop_map(|lines| {
        lines
            .iter()
            .map(|(key, value)| format!("{key} = {value}\n"))
            .collect()
    })
}

fn recording() -> impl Strategy<Value = Recording> {
    let sample = (
        1e-6f64..1.0,
        any_finite(),
        // A counter that jumps is repaired or refused, and another law's.
        -1000..1000,
        any_finite(),
        any::<bool>(),
    );
    (
        prop::collection::vec(sample, 2..50),
        any::<bool>(),
        any::<bool>(),
        -1e6f64..1e6,
    )
        .prop_map(|(samples, with_current, with_enabled, start)| {
            let mut time = start;
            let mut time_s = Vec::new();
            for sample in &samples {
                time += sample.0;
                time_s.push(time);
            }
            Recording {
                source: "rec.csv".into(),
                time_s,
                command: samples.iter().map(|sample| sample.1).collect(),
                counts: (samples.iter())
                    .scan(0, |count, sample| {
                        *count += sample.2;
                        Some(f64::from(*count))
                    })
                    .collect(),
                measured: Series::NONE.with(
                    Measured::Current,
                    with_current.then(|| samples.iter().map(|sample| sample.3).collect()),
                ),
                enabled: with_enabled.then(|| samples.iter().map(|sample| sample.4).collect()),
                counts_per_rev: 2048.0,
                quantised: true,
                supply_v: None,
                drive: Drive::Voltage,
                position: None,
            }
        })
}

fn any_finite() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::num::f64::NORMAL,
        prop::num::f64::SUBNORMAL,
        prop::num::f64::ZERO,
        -100.0f64..100.0
    ]
}

fn motor_file() -> impl Strategy<Value = MotorFile> {
    let positive = || prop::option::of(prop::num::f64::POSITIVE | prop::num::f64::SUBNORMAL);
    let name = || prop::option::of("[ -~äöü]{0,6}[a-z]");
    let fact = || {
        let tolerance = prop::option::of(1e-6f64..0.999);
        let value = prop::num::f64::POSITIVE;
        prop::option::of(
            (value, tolerance).prop_map(|(value, tolerance)| Fact { value, tolerance }),
        )
    };
    let columns = (name(), name(), name(), name(), name()).prop_map(
        |(time, voltage, angle, current, enabled)| {
            let trimmed = |name: Option<String>| name.map(|name| name.trim().to_string());
            let further = |end: &str| enabled.clone().map(|name| format!("{name}_{end}"));
            let mut columns = Columns::default();
            for (channel, name) in [
                (Channel::Time, time),
                (Channel::Command, voltage),
                (Channel::Angle, angle),
                (Channel::Measured(Measured::Temperature), further("c")),
                (Channel::Measured(Measured::Supply), further("v")),
                (Channel::Measured(Measured::Current), current),
                (Channel::Enabled, enabled.clone()),
                (Channel::Direction, further("direction")),
            ] {
                columns.set(channel, trimmed(name));
            }
            columns
        },
    );
    let of_motor = (fact(), fact(), fact(), fact(), fact(), fact(), fact());
    let known =
        (of_motor, fact(), fact()).prop_map(|((r, l, kt, kb, j, f, w), carrier, dead)| Known {
            resistance_ohm: r,
            inductance_h: l,
            kt_n_m_a: kt,
            kb_v_s_rad: kb,
            inertia_kg_m2: j,
            viscous_n_m_s: f,
            unbalance_n_m: w,
            carrier_hz: carrier,
            dead_time_s: dead,
            kt_equals_kb: kt.is_none() || kb.is_none(),
        });
    let numbers = (
        prop::option::of("\\PC*"),
        positive(),
        positive(),
        positive(),
    );
    let units = (
        0..TimeUnit::ALL.len(),
        0..CommandUnit::ALL.len(),
        0..AngleUnit::ALL.len() + AngleUnit::SPEEDS.len(),
        0..2usize,
        0..6usize,
        any::<[bool; 3]>(),
    );
    let log = (
        prop::option::of("[a-z/]{1,8}"),
        positive(),
        prop::collection::vec(("[a-z]{1,5}", "[a-z0-9.]{1,5}"), 0..3),
        prop::option::of((1e-3f64..1e3, 1e-3f64..1e3)),
    );
    let position = prop::option::of((positive(), positive(), positive(), positive(), positive()));
    (numbers, columns, units, position, known, log).prop_map(
        |(
            (name, counts, supply, metres),
            columns,
            (t, v, a, i, target, [turned_v, turned_a, turned_i]),
            position,
            known,
            (table, rate_hz, select, span),
        )| {
            let position = position.map(|(gain, damping, limit, dead, rate)| LoopSettings {
                gain_v_per_rad: gain,
                damping_v_s_per_rad: damping,
                limit_v: limit,
                dead_band_rad: dead,
                rate_hz: rate,
            });
            let voltage = match position {
                None => CommandUnit::ALL[v].1,
                Some(_) => CommandUnit::default(),
            };
            let target = position.and(AngleUnit::ALL.get(target));
            let bridge = !matches!(
                voltage,
                CommandUnit::Amperes | CommandUnit::Milliamperes | CommandUnit::NewtonMetres
            );
            // A position loop needs the angle itself.
            let angles = match position {
                None => [AngleUnit::ALL, AngleUnit::SPEEDS].concat(),
                Some(_) => AngleUnit::ALL.to_vec(),
            };
            MotorFile {
                source: Some("motor.toml".into()),
                name,
                counts_per_rev: counts,
                supply_v: supply,
                metres_per_rev: metres,
                columns,
                units: Units {
                    time: TimeUnit::ALL[t].1,
                    voltage,
                    target: target.map(|(_, unit)| *unit),
                    angle: angles[a % angles.len()].1,
                    measured: PerMeasured([i % 2, t % 3, i % 2]),
                    reversed: Reversed {
                        voltage: turned_v && position.is_none(),
                        angle: turned_a,
                        measured: PerMeasured([turned_i, false, false]),
                    },
                },
                log: LogPart {
                    preset: None,
                    table,
                    rate_hz,
                    select: (select.into_iter())
                        .map(|(column, value)| Selection { column, value })
                        .collect(),
                    from_s: span.map(|(from, _)| from),
                    to_s: span.map(|(from, length)| from + length),
                },
                drive: if bridge {
                    Drive::Voltage
                } else {
                    Drive::Current
                },
                drive_said: position.is_some() || !bridge,
                position,
                known,
            }
        },
    )
}

proptest! {
    #[test]
    fn any_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..300), turn in 0..TURNS) {
        read_in_turn(&bytes, turn);
        if let Ok(text) = std::str::from_utf8(&bytes) {
            drop(MotorFile::parse(text, "motor.toml"));
        }
    }

    #[test]
    fn any_csv_is_read_or_refused(text in csv_like(), turn in 0..TURNS) {
        read_in_turn(text.as_bytes(), turn);
    }

    #[test]
    fn any_toml_is_read_or_refused(text in toml_like()) {
        if let Err(error) = MotorFile::parse(&text, "motor.toml") {
            prop_assert!(error.to_string().starts_with("motor.toml:"));
        }
    }

    #[test]
    fn what_is_written_is_read_back_the_same(recording in recording(), comment in "\\PC*[\r\n]?\\PC*") {
        let mut bytes = Vec::new();
        write_csv(&mut bytes, &recording, &[comment]).unwrap();
        let motor = MotorFile { counts_per_rev: Some(2048.0), ..MotorFile::default() };
        let back = read_recording_from(&bytes[..], "rec.csv", &motor).unwrap();
        prop_assert_eq!(back, recording);
    }

    #[test]
    fn a_motor_file_is_read_back_the_same(motor in motor_file()) {
        let text = motor.to_toml();
        let back = MotorFile::parse(&text, "motor.toml");
        prop_assert!(back.is_ok(), "{}\n{}", back.unwrap_err(), text);
        prop_assert_eq!(back.unwrap(), motor, "{}", text);
    }
}

/// A position drive's targets are written in place of its volts, which come back.
#[test]
fn targets_are_written_and_read_back_the_same() {
    for angle in ["angle_counts", "angle_rev"] {
        let rows: String = (0..40)
            .map(|k| format!("{},{},{}\n", f64::from(k) / 1e3, 5 * k, k * k))
            .collect();
        let unit = if angle == "angle_rev" {
            "rev"
        } else {
            "counts"
        };
        let toml = format!(
            "counts_per_rev = 2000\nsupply_v = 12\n[units]\nangle = \"{unit}\"\n[drive]\nkind = \"position\"\n\
             gain_v_per_rad = 3\n"
        );
        let motor = MotorFile::parse(&toml, "motor.toml").unwrap();
        let text = format!("t_s,target_{unit},{angle}\n{rows}");
        let recording = read_recording_from(text.as_bytes(), "rec.csv", &motor).unwrap();
        let mut bytes = Vec::new();
        write_csv(&mut bytes, &recording, &[]).unwrap();
        let counted = MotorFile::parse(&toml.replace("\"rev\"", "\"counts\""), "motor.toml");
        let back = read_recording_from(&bytes[..], "rec.csv", &counted.unwrap()).unwrap();
        assert_eq!(back, recording, "{unit}");
    }
}

/// The same motion in every unit gives the same counts.
#[test]
fn units_agree() {
    let counts: Vec<i32> = (0..200).map(|k| k * k / 7 - 900).collect();
    let revolution = [
        ("counts", 2048.0),
        ("deg", 360.0),
        ("rad", std::f64::consts::TAU),
        ("rev", 1.0),
        ("m", 0.0025),
    ];
    for (unit, per_rev) in revolution {
        for (time_unit, per_second) in [("s", 1.0), ("ms", 1e3), ("us", 1e6)] {
            let toml = format!(
                "counts_per_rev = 2048\nsupply_v = 12\nmetres_per_rev = 0.0025\n[columns]\ntime = \"t\"\nvoltage = \"u\"\n\
                 angle = \"a\"\ncurrent = \"i\"\n[units]\ntime = \"{time_unit}\"\nangle = \"{unit}\"\nvoltage = \"duty\"\n\
                 current = \"mA\"\n"
            );
            let motor = MotorFile::parse(&toml, "motor.toml").unwrap();
            let mut text = String::from("t;u;a;i;ignored\r\n");
            for (k, counts) in counts.iter().enumerate() {
                let time = k as f64 / 1e3 * per_second;
                let angle = f64::from(*counts) / 2048.0 * per_rev;
                text += &format!("{time};0.5;{angle};250;text\r\n");
            }
            let recording = read_recording_from(text.as_bytes(), "rec.csv", &motor).unwrap();
            assert!(recording.quantised, "{unit}");
            assert_eq!(
                recording.counts,
                counts.iter().map(|x| f64::from(*x)).collect::<Vec<_>>(),
                "{unit}"
            );
            assert_eq!(recording.time_s[3], 0.003);
            assert!(recording.command.iter().all(|x| *x == 6.0));
            assert!(
                recording
                    .measured
                    .get(Measured::Current)
                    .unwrap()
                    .iter()
                    .all(|x| *x == 0.25)
            );
        }
    }
}

#[test]
fn an_angle_that_is_no_counter_is_kept_and_written_in_revolutions() {
    let toml = "counts_per_rev = 4096\n[units]\nangle = \"rev\"\n";
    let motor = MotorFile::parse(toml, "motor.toml").unwrap();
    let mut text = String::from("t_s,voltage_v,angle_rev\n");
    for k in 0..100 {
        text += &format!("{k},1,{:?}\n", f64::from(k * k) * 0.000_123_4);
    }
    let recording = read_recording_from(text.as_bytes(), "rec.csv", &motor).unwrap();
    assert!(!recording.quantised);
    let mut bytes = Vec::new();
    write_csv(&mut bytes, &recording, &[]).unwrap();
    let back = read_recording_from(&bytes[..], "rec.csv", &motor).unwrap();
    for (x, y) in recording.counts.iter().zip(&back.counts) {
        assert!((x - y).abs() <= 1e-12 * x.abs());
    }
}

#[test]
fn a_recording_can_be_split_to_hold_a_part_out() {
    let text =
        "t_s,voltage_v,angle_counts,enabled\n5,1,0,1\n6,2,10,1\n7,3,20,0\n8.5,4,30,1\n9,5,40,1\n";
    let motor = MotorFile {
        counts_per_rev: Some(4.0),
        ..MotorFile::default()
    };
    let recording = read_recording_from(text.as_bytes(), "rec.csv", &motor).unwrap();
    assert_eq!(recording.duration_s(), 4.0);
    assert_eq!(recording.median_interval_s(), 1.0);
    let (before, after) = recording.split_at(2.0).unwrap();
    check_promises(&before);
    check_promises(&after);
    assert_eq!(before.time_s, [5.0, 6.0]);
    assert_eq!(after.time_s, [7.0, 8.5, 9.0]);
    assert_eq!(after.enabled, Some(vec![false, true, true]));
    for seconds in [f64::NAN, -1.0, 0.0, 1.0, 3.6, 1e9] {
        assert!(recording.split_at(seconds).is_none());
    }
}

#[test]
fn a_recording_is_written_to_a_file_with_its_provenance() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.csv");
    let text = "t_s,voltage_v,angle_counts\n0,1,0\n1,1,5\n";
    let motor = MotorFile {
        counts_per_rev: Some(4.0),
        ..MotorFile::default()
    };
    let recording = read_recording_from(text.as_bytes(), "rec.csv", &motor).unwrap();
    write_recording(&path, &recording, &["seed 7".into(), "two\nlines".into()]).unwrap();
    let written = std::fs::read_to_string(&path).unwrap();
    assert_eq!(
        written,
        "# seed 7\n# two\n# lines\nt_s,voltage_v,angle_counts\n0.0,1.0,0\n1.0,1.0,5\n"
    );
}
