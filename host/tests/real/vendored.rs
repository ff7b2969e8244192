//! The folder of recordings itself: nothing lies there unread or without its notices.

use servoid_io::input::{MotorFile, read_recording};
use std::fs;
use std::path::Path;
use testing::recordings::{Vendored, map};

/// The curves, which no recording in time is made of; `steady` and `diagnoses` read them.
const CURVES: [&str; 4] = [
    "bam_mx_static/mx106_noload_speed.csv",
    "bam_mx_static/mx64_noload_speed.csv",
    "odrive_cogging/holding_current_map_a_16.csv",
    "un_dcmotor/static_gain.csv",
];

#[test]
fn whatever_is_kept_is_read_and_has_its_notices() {
    let names = Vendored::names();
    for curve in CURVES {
        assert!(names.iter().any(|name| name == curve), "{curve} is gone");
    }
    let recordings = Vendored::new();
    for name in &names {
        let (source, _) = name.split_once('/').expect("a folder and a name");
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../tests/recordings")
            .join(source);
        for (file, says) in [("NOTICE", "Source: https://"), ("LICENSE", "icense")] {
            let text = fs::read_to_string(folder.join(file))
                .unwrap_or_else(|error| panic!("{source}/{file}: {error}"));
            assert!(text.contains(says), "{source}/{file}");
        }
        let path = recordings.unpack(name);
        if CURVES.contains(&name.as_str()) {
            continue;
        }
        let motor = MotorFile::read(&map(&format!("{source}.toml")))
            .unwrap_or_else(|error| panic!("{error}"));
        read_recording(&path, &motor).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
