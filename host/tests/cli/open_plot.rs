//! Logs drawn by `servoid open --plot`, of which nothing else is known.

use super::desk::Desk;
use std::fs;
use std::path::Path;

/// The texts of a drawing, which must be whole XML.
fn texts(desk: &Desk, name: &str) -> Vec<String> {
    let svg = desk.read(name);
    let document = roxmltree::Document::parse(&svg).expect("whole XML");
    let texts = document
        .descendants()
        .filter(|node| node.has_tag_name("text"));
    texts
        .map(|node| node.text().unwrap_or_default().trim().to_owned())
        .collect()
}

/// The lines of all columns, without those of frames: points with commas between their coordinates.
fn points(desk: &Desk, name: &str) -> usize {
    let svg = desk.read(name);
    let document = roxmltree::Document::parse(&svg).expect("whole XML");
    let lines = document
        .descendants()
        .filter_map(|node| node.attribute("points"));
    lines.map(|points| points.split_whitespace().count()).sum()
}

#[test]
fn a_log_is_drawn_without_a_word_about_its_motor() {
    let desk = Desk::new();
    let mut log = "time,pwm_duty,theta_rad,temperature,state\n".to_owned();
    for k in 0..5000 {
        let angle = if (2000..2500).contains(&k) {
            "NaN".to_owned()
        } else {
            format!("{}", 0.01 * f64::from(k))
        };
        let duty = if k % 1000 < 500 { 0.25 } else { -0.5 };
        log += &format!("{},{duty},{angle},20,run\n", 1e-3 * f64::from(k));
    }
    desk.write("log.csv", log);
    let outcome = desk.done("open log.csv --plot log.svg");
    assert!(outcome.stderr.contains("plot: log.svg"), "{outcome}");
    let texts = texts(&desk, "log.svg");
    for said in [
        "log.csv: text with columns",
        "5000 rows",
        "pwm_duty",
        "voltage, duty",
        "-0.5",
        "0.25",
        "theta_rad",
        "angle, rad",
        "49.99",
        "temperature",
        "20",
        "no numbers: state",
        "time",
    ] {
        assert!(texts.iter().any(|text| text == said), "{said}: {texts:?}");
    }
}

#[test]
fn a_long_log_is_a_small_drawing_that_keeps_its_spikes() {
    let desk = Desk::new();
    let mut log = "t_s,voltage_v,angle_counts\n".to_owned();
    for k in 0..200_000 {
        let volts = if k == 123_456 { 24.0 } else { 1.0 };
        log += &format!("{},{volts},{k}\n", 1e-3 * f64::from(k));
    }
    desk.write("long.csv", log);
    desk.done("open long.csv --plot long.svg");
    assert!(texts(&desk, "long.svg").iter().any(|text| text == "24"));
    assert!(points(&desk, "long.svg") < 10_000);
    assert!(desk.read("long.svg").len() < 200_000);
}

#[test]
fn one_row_no_row_and_no_number_are_drawn_as_they_are() {
    let desk = Desk::new();
    desk.write("one.csv", "t_s,voltage_v,angle_counts\n0.5,3,17\n");
    desk.done("open one.csv --plot one.svg");
    let one = texts(&desk, "one.svg");
    for said in ["1 row", "voltage_v", "3", "angle_counts", "17"] {
        assert!(one.iter().any(|text| text == said), "{said}: {one:?}");
    }
    assert!(desk.read("one.svg").contains("<circle"));

    desk.write("none.csv", "t_s,voltage_v,angle_counts\n");
    desk.done("open none.csv --plot none.svg");
    let none = texts(&desk, "none.svg");
    assert!(none.iter().any(|text| text == "0 rows"), "{none:?}");
    assert_eq!(points(&desk, "none.svg"), 0);

    desk.write(
        "nan.csv",
        "t_s,voltage_v,angle_counts\nNaN,NaN,NaN\nNaN,NaN,NaN\n",
    );
    desk.done("open nan.csv --plot nan.svg");
    let nan = texts(&desk, "nan.svg");
    let said = "no numbers: t_s, voltage_v, angle_counts";
    assert!(nan.iter().any(|text| text == said), "{nan:?}");
}

#[test]
fn numbers_of_any_size_are_drawn() {
    let desk = Desk::new();
    let ends = [
        "1.7e308",
        "-1.7e308",
        "5e-324",
        "1e17",
        "10000000000000000016",
        "0",
    ];
    for (k, a) in ends.iter().enumerate() {
        for b in &ends[k..] {
            let rows = format!("time,x\n{a},{b}\n{b},{a}\n");
            desk.write("ends.csv", &rows);
            desk.done("open ends.csv --plot ends.svg");
            assert!(!texts(&desk, "ends.svg").is_empty(), "{rows}");
        }
    }
}

#[test]
fn as_many_columns_as_come_are_bounded() {
    let desk = Desk::new();
    let names: Vec<String> = (0..100).map(|k| format!("joint_{k}_position")).collect();
    let mut log = format!("t_s,{},voltage_v\n", names.join(","));
    for row in 0..20 {
        let cells: Vec<String> = (0..100).map(|k| format!("{}", row * k)).collect();
        log += &format!("{row},{},{}\n", cells.join(","), row % 5);
    }
    desk.write("wide.csv", log);
    desk.done("open wide.csv --plot wide.svg");
    let texts = texts(&desk, "wide.svg");
    // What is the motor's is drawn, wherever it stands.
    for said in ["voltage_v", "not drawn: 41 more columns"] {
        assert!(texts.iter().any(|text| text == said), "{said}: {texts:?}");
    }
}

#[test]
fn a_log_that_cannot_be_read_leaves_no_drawing() {
    let desk = Desk::new();
    desk.write("cut.npy", b"\x93NUMPY\x01\x00v\x00{'descr': '<f8'");
    desk.write("bad.csv", "t_s,voltage_v\n0,\"1\n");
    desk.write("log.csv", "t_s,voltage_v\n0,1\n1,2\n");
    desk.refused("open cut.npy --plot out.svg", 1, &["cut.npy"]);
    desk.refused("open bad.csv --plot out.svg", 1, &["bad.csv:2"]);
    desk.refused("open none.csv --plot out.svg", 1, &["none.csv"]);
    desk.refused(
        "open log.csv --plot log.csv",
        2,
        &["--plot", "the recording"],
    );
    desk.refused("open log.csv --plot none/out.svg", 2, &["--plot"]);
    desk.refused("open log.csv --plot a.svg --json a.svg", 2, &["--json"]);
}

#[test]
fn logs_of_all_formats_are_drawn() {
    let desk = Desk::new();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("formats/tests/fixtures");
    let mut drawn = 0;
    for folder in [
        "compressed",
        "hdf5",
        "json",
        "lerobot",
        "matlab",
        "mcap",
        "numpy",
        "parquet",
        "wpilog",
    ] {
        for entry in fs::read_dir(fixtures.join(folder)).expect("a folder of fixtures") {
            let path = entry.expect("an entry").path();
            let outcome = desk.run(&format!("open {} --plot out.svg", path.display()));
            let is_there = desk.path("out.svg").exists();
            assert_eq!(is_there, outcome.code == Some(0), "{outcome}");
            if is_there {
                let texts = texts(&desk, "out.svg");
                assert!(texts.len() > 1, "{outcome}\n{texts:?}");
                fs::remove_file(desk.path("out.svg")).expect("the drawing");
                drawn += 1;
            }
        }
    }
    assert!(drawn > 60, "{drawn}");
}
