//! Datasets in LeRobot's layout, written with pyarrow.

mod read;

use read::{assert_same, column, fixture, names, of, opened};
use servoid_formats::{Format, FormatFault, Kind, Log, open};
use std::path::Path;

const LENGTHS: [usize; 3] = [6, 4, 5];

fn episodes(log: &mut dyn Log) {
    assert_eq!(log.format(), Format::LeRobot);
    let tables: Vec<(&str, Option<u64>)> = log
        .tables()
        .iter()
        .map(|table| (table.name.as_str(), table.rows))
        .collect();
    assert_eq!(
        tables,
        [
            ("episode 0", Some(6)),
            ("episode 1", Some(4)),
            ("episode 2", Some(5))
        ]
    );
    let expected = [
        "observation.state.shoulder_pan.pos",
        "observation.state.elbow.pos",
        "observation.state.gripper.pos",
        "action[0]",
        "action[1]",
        "action[2]",
        "next.done",
        "timestamp",
        "frame_index",
        "episode_index",
        "index",
        "task_index",
    ];
    assert_eq!(names(&log.tables()[0]), expected);
    let kinds = [6, 7, 8].map(|column| log.tables()[0].columns[column].kind);
    assert_eq!(kinds, [Kind::Flag, Kind::Time, Kind::Number]);
    for (episode, length) in LENGTHS.into_iter().enumerate() {
        let name = format!("episode {episode}");
        let elbow = of(length, |k| 100.0 * episode as f64 + k + 0.25);
        assert_same(&column(log, &name, "observation.state.elbow.pos"), &elbow);
        assert_same(&column(log, &name, "action[2]"), &of(length, |k| -k - 2.0));
        let time = of(length, |k| f64::from((k / 30.0) as f32));
        assert_same(&column(log, &name, "timestamp"), &time);
        assert_same(&column(log, &name, "frame_index"), &of(length, |k| k));
        let done = of(length, |k| f64::from(u8::from(k == length as f64 - 1.0)));
        assert_same(&column(log, &name, "next.done"), &done);
    }
}

#[test]
fn each_episode_of_version_3_is_a_table() {
    episodes(&mut *opened("lerobot/v3"));
}

#[test]
fn each_episode_of_version_2_is_a_table() {
    episodes(&mut *opened("lerobot/v21"));
}

fn copied(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copied(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}

#[test]
fn without_a_list_of_episodes_the_data_say_which_there_are() {
    for (version, list) in [("v3", "meta/episodes"), ("v21", "meta/episodes.jsonl")] {
        let folder = tempfile::tempdir().unwrap();
        copied(&fixture("lerobot").join(version), folder.path());
        let list = folder.path().join(list);
        if list.is_dir() {
            std::fs::remove_dir_all(list).unwrap();
        } else {
            std::fs::remove_file(list).unwrap();
        }
        let mut log = open(folder.path()).unwrap().unwrap();
        assert_eq!(log.tables().len(), 3);
        let last = column(&mut *log, "episode 2", "action[0]");
        assert_same(&last, &of(5, |k| -k));
    }
}

#[test]
fn one_file_is_opened_at_a_time_and_only_when_it_is_read() {
    let folder = tempfile::tempdir().unwrap();
    copied(&fixture("lerobot/v3"), folder.path());
    let lost = folder.path().join("data/chunk-000/file-001.parquet");
    std::fs::remove_file(&lost).unwrap();
    let mut log = open(folder.path()).unwrap().unwrap();
    assert_same(&column(&mut *log, "episode 1", "action[0]"), &of(4, |k| -k));
    let error = log
        .read(2, &[0], &mut |_| panic!("nothing is there"))
        .unwrap_err();
    assert_eq!(error.source_name, lost.display().to_string());
    assert!(matches!(error.fault, FormatFault::Io(_)), "{error}");
}

#[test]
fn other_versions_and_other_folders_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    assert!(
        open(folder.path()).unwrap().is_none(),
        "a folder of anything"
    );
    std::fs::create_dir(folder.path().join("meta")).unwrap();
    let info = folder.path().join("meta/info.json");
    std::fs::write(&info, r#"{"codebase_version":"v1.6","features":{}}"#).unwrap();
    let Err(error) = open(folder.path()) else {
        panic!("version 1 has another layout")
    };
    assert!(
        matches!(error.fault, FormatFault::Unsupported { .. }),
        "{error}"
    );
}
