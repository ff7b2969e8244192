//! Results that cannot be put where they were asked for.

use std::fs;

use crate::desk::Desk;

#[test]
fn a_missing_folder_is_named_and_nothing_is_left() {
    let desk = Desk::with_recording();
    desk.write("folder/inside.txt", "");
    for line in [
        "simulate --seconds 1 --out",
        "demo --out",
        "fit rec.csv --plot",
        "compare rec.csv --seeds 1 --budget 5 --plot",
    ] {
        desk.refused(
            &format!("{line} missing/out"),
            1,
            &["missing/out", "make it first"],
        );
        desk.refused(&format!("{line} folder"), 1, &["folder", "is a folder"]);
    }
}

#[test]
fn json_that_cannot_be_written_fails_the_run() {
    let desk = Desk::with_recording();
    desk.write("folder/inside.txt", "");
    let before = desk.listing();
    for line in [
        "fit rec.csv",
        "compare rec.csv --seeds 1 --budget 5",
        "simulate --list",
    ] {
        let missing = desk.run(&format!("{line} --json missing/out.json"));
        missing.is_refusal(1, &["missing/out.json", "make it first"]);
        desk.run(&format!("{line} --json folder"))
            .is_refusal(1, &["folder", "is a folder"]);
        assert_eq!(desk.listing(), before, "{missing}");
    }
}

#[cfg(unix)]
#[test]
fn an_old_result_survives_a_failed_run_and_a_link_stays_a_link() {
    let desk = Desk::with_recording();
    desk.write("real.json", "old");
    std::os::unix::fs::symlink(desk.path("real.json"), desk.path("link.json")).expect("a link");
    desk.write("bad.csv", "t_s,voltage_v,angle_counts\n0,1,x\n");
    desk.refused("fit bad.csv --json link.json", 1, &["bad.csv:2:3"]);
    assert_eq!(desk.read("real.json"), "old");
    desk.done("fit rec.csv --json link.json");
    assert!(desk.read("real.json").contains("servoid.fit/1"));
    let link = fs::symlink_metadata(desk.path("link.json")).expect("the link");
    assert!(link.file_type().is_symlink());
}
