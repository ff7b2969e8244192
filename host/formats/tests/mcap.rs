//! MCAP files of the format's own library, with messages of ROS 2, ROS 1, JSON and protobuf.

mod read;

use read::{assert_same, column, fixture, names, numeric, of, opened, rows, table};
use servoid_formats::{Format, FormatFault, Kind, Log, open};

fn seconds(k: f64) -> f64 {
    1_000_001.0 * k / 1e9
}

fn joint_states(log: &mut dyn Log, topic: &str, count: usize) {
    let (_, found) = table(log, topic);
    assert_eq!(found.rows, Some(count as u64));
    let time = found
        .columns
        .iter()
        .find(|column| column.name == "header.stamp");
    assert_eq!(time.map(|column| column.kind), Some(Kind::Time));
    assert_same(&column(log, topic, "log_time"), &of(count, seconds));
    assert_same(&column(log, topic, "header.stamp"), &of(count, seconds));
    assert_same(
        &column(log, topic, "position[elbow]"),
        &of(count, |k| 0.25 * k),
    );
    assert_same(
        &column(log, topic, "position[wrist]"),
        &of(count, |k| -0.5 * k),
    );
    let grip = of(count, |k| if k < 2.0 { f64::NAN } else { 14.0 });
    assert_same(&column(log, topic, "velocity[grip]"), &grip);
}

fn all_types(log: &mut dyn Log, topic: &str, count: usize, step: f64) {
    let mut same = |name: &str, value: &dyn Fn(f64) -> f64| {
        let found = column(log, topic, name);
        assert_same(&found, &of(count, |k| value(step * k)));
    };
    same("flag", &|k| k % 2.0);
    same("octet", &|k| k);
    same("letter", &|_| 65.0);
    same("i8", &|k| -k);
    same("u8", &|k| k);
    same("i16", &|k| -300.0 * k);
    same("u16", &|k| 300.0 * k);
    same("i32", &|k| -70_000.0 * k);
    same("u32", &|k| 70_000.0 * k);
    same("i64", &|k| -5e9 * k);
    same("u64", &|k| 5e9 * k);
    same("f32", &|k| 0.5 * k);
    same("f64", &|k| 0.125 * k);
    same("three[2]", &|k| k + 2.0);
    same("any[1]", &|k| if k % 3.0 == 2.0 { 1.0 } else { f64::NAN });
    same("few[1]", &|k| 2.0 * k);
    same("points[1].y", &|k| 4.0 * k);
    same("path[0].x", &|_| 5.0);
    same("took", &|_| -0.5);
    same("last", &|k| 1.5 * k);
    let (_, found) = table(log, topic);
    let kind = |name: &str| {
        let column = found.columns.iter().find(|column| column.name == name);
        column.map(|column| column.kind)
    };
    assert_eq!(kind("text"), Some(Kind::Text));
    assert_eq!(kind("words"), Some(Kind::Text));
    assert_eq!(kind("image"), Some(Kind::Text), "too long for columns");
    assert_eq!(kind("flag"), Some(Kind::Flag));
}

#[test]
fn messages_of_ros_2_are_decoded_from_chunks_of_all_compressions() {
    for (name, count) in [("zstd", 40), ("lz4", 10), ("none", 10)] {
        let mut log = opened(&format!("mcap/ros2_{name}.mcap"));
        assert_eq!(log.format(), Format::Mcap);
        let topics: Vec<&str> = log
            .tables()
            .iter()
            .map(|table| table.name.as_str())
            .collect();
        assert_eq!(topics, ["/joint_states", "/all"]);
        joint_states(&mut *log, "/joint_states", count);
        all_types(&mut *log, "/all", count / 2, 2.0);
    }
}

/// In chunks and without them.
const ENCODINGS: [&str; 2] = ["mcap/encodings.mcap", "mcap/encodings_plain.mcap"];

#[test]
fn messages_of_the_other_byte_order_are_decoded() {
    for name in ENCODINGS {
        all_types(&mut *opened(name), "/big", 12, 1.0);
    }
}

#[test]
fn messages_of_ros_1_are_decoded() {
    for name in ENCODINGS {
        joint_states(&mut *opened(name), "/ros1", 12);
    }
}

#[test]
fn messages_of_protobuf_are_decoded() {
    for name in ENCODINGS {
        let mut log = opened(name);
        let mut same = |name: &str, value: &dyn Fn(f64) -> f64| {
            let found = column(&mut *log, "/proto", name);
            assert_same(&found, &of(12, value));
        };
        same("stamp", &seconds);
        same("angle", &|k| 0.5 * k);
        same("counts", &|k| k);
        same("raw[1]", &|k| 2.0 * k);
        same("enabled", &|k| 1.0 - k % 2.0);
        let odd = |k: f64, value: f64| if k % 2.0 == 1.0 { value } else { f64::NAN };
        same("inner.current", &|k| odd(k, 0.25 * k));
    }
}

#[test]
fn messages_of_json_are_decoded_with_and_without_a_schema() {
    let mut log = opened("mcap/json.mcap");
    let (_, motor) = table(&*log, "motor");
    let expected = [
        "log_time",
        "current",
        "joint.angle",
        "joint.raw[0]",
        "joint.raw[1]",
        "name",
        "on",
        "stamp",
    ];
    assert_eq!(names(motor), expected);
    assert_same(
        &column(&mut *log, "motor", "joint.angle"),
        &of(20, |k| 2.0 * k),
    );
    assert_same(&column(&mut *log, "motor", "joint.raw[1]"), &of(20, |k| -k));
    assert_same(&column(&mut *log, "motor", "stamp"), &of(20, seconds));
    let current = of(20, |k| if k < 3.0 { f64::NAN } else { 0.25 * k });
    assert_same(&column(&mut *log, "motor", "current"), &current);
    assert_same(&column(&mut *log, "bare", "value"), &of(20, |k| 0.5 * k));
}

#[test]
fn what_cannot_be_decoded_still_has_its_times() {
    let mut log = opened("mcap/json.mcap");
    let (number, found) = table(&*log, "idl");
    assert_eq!(names(found), ["log_time", "message"]);
    assert_same(&column(&mut *log, "idl", "log_time"), &of(20, seconds));
    let (_, read) = rows(&mut *log, number, &[0, 1]);
    let error = read.unwrap_err();
    assert!(
        matches!(error.fault, FormatFault::Unsupported { .. }),
        "{error}"
    );
}

#[test]
fn a_recording_that_was_cut_short_is_read_up_to_the_cut() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.mcap");
    for name in ["ros2_zstd", "ros2_lz4", "ros2_none"] {
        let mut whole = opened(&format!("mcap/{name}.mcap"));
        let expected = column(&mut *whole, "/joint_states", "position[elbow]");
        let bytes = std::fs::read(fixture(&format!("mcap/{name}.mcap"))).unwrap();
        let mut most = 0;
        for length in (2_000..bytes.len()).step_by(97) {
            std::fs::write(&path, &bytes[..length]).unwrap();
            let mut log = open(&path).unwrap().unwrap();
            let (number, found) = table(&*log, "/joint_states");
            let Some(at) = names(found)
                .iter()
                .position(|name| *name == "position[elbow]")
            else {
                continue;
            };
            let said = found.rows;
            let (found, read) = rows(&mut *log, number, &[at]);
            assert_same(&found[0], &expected[..found[0].len()]);
            assert_eq!(said, Some(found[0].len() as u64));
            assert!(found[0].len() >= most, "more of the file has less");
            most = found[0].len();
            if let Err(error) = read {
                assert!(
                    matches!(error.fault, FormatFault::CutShort { .. }),
                    "{error}"
                );
            }
        }
        assert_eq!(most, expected.len(), "the summary alone was cut");
    }
}

#[test]
fn a_chunk_whose_checksum_is_wrong_gives_no_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("changed.mcap");
    let mut bytes = std::fs::read(fixture("mcap/ros2_none.mcap")).unwrap();
    // A position of the first message: 0.25, the elbow's second, is further on.
    let at = bytes
        .windows(8)
        .position(|eight| eight == 0.25_f64.to_le_bytes())
        .unwrap();
    bytes[at] = 1;
    std::fs::write(&path, &bytes).unwrap();
    let mut log = open(&path).unwrap().unwrap();
    let numbers = numeric(&log.tables()[0]);
    let (found, read) = rows(&mut *log, 0, &numbers);
    let error = read.unwrap_err();
    assert!(
        matches!(error.fault, FormatFault::Damaged { .. }),
        "{error}"
    );
    assert!(found.iter().all(Vec::is_empty), "{found:?}");
}
