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
        "fit rec.csv --report",
        "diagnose rec.csv --report",
        "compare rec.csv --seeds 1 --budget 5 --report",
        "paper --report",
        "report fit.json --out",
    ] {
        desk.refused(
            &format!("{line} missing/out"),
            2,
            &["missing/out", "make it first"],
        );
        desk.refused(&format!("{line} folder"), 2, &["folder", "is a folder"]);
    }
}

#[test]
fn json_that_cannot_be_written_is_refused_before_the_work() {
    let desk = Desk::with_recording();
    desk.write("folder/inside.txt", "");
    for line in [
        "fit rec.csv",
        "compare rec.csv --seeds 1 --budget 5",
        "simulate --list",
        "simulate --out new.csv",
        "demo",
        "paper",
    ] {
        desk.refused(
            &format!("{line} --json missing/out.json"),
            2,
            &["--json missing/out.json", "make it first"],
        );
        desk.refused(
            &format!("{line} --json folder"),
            2,
            &["--json folder", "is a folder"],
        );
    }
}

#[test]
fn no_result_replaces_what_the_run_reads() {
    let desk = Desk::with_recording();
    desk.write("sub/other.csv", desk.read("rec.csv"));
    for (line, says) in [
        ("fit rec.csv --json rec.csv", "the recording"),
        ("fit rec.csv --plot sub/../rec.csv", "the recording"),
        ("fit rec.csv --plot motor.toml", "the motor file"),
        (
            "fit rec.csv --validate sub/other.csv --json ./sub/other.csv",
            "--validate",
        ),
        ("fit rec.csv --json out --plot out", "is also --plot"),
        ("compare rec.csv --json rec.csv", "the recording"),
        ("compare rec.csv --plot rec.csv", "the recording"),
        ("simulate --out motor.toml", "the motor file"),
        ("simulate --out new.csv --json motor.toml", "the motor file"),
        ("simulate --out new.csv --json new.csv", "is also --out"),
        ("demo --out new --json new", "is also --out"),
    ] {
        desk.refused(line, 2, &[says, "name another file"]);
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

#[test]
fn the_bench_replaces_its_own_recordings_and_nobody_elses() {
    let desk = Desk::new();
    desk.write("measured.csv", "t_s,voltage_v,angle_counts\n0,1,0\n");
    for verb in [
        "simulate --seconds 1",
        "simulate --plan --between coulomb,delay --seconds 5",
    ] {
        desk.refused(
            &format!("{verb} --out measured.csv"),
            2,
            &["not made by simulate", "another name"],
        );
        assert!(desk.read("measured.csv").ends_with("0,1,0\n"));
    }
    desk.done("simulate --seconds 1 --out bench.csv");
    desk.done("simulate --seconds 1 --seed 2 --out bench.csv");
    assert!(desk.read("bench.csv").contains("seed 2"));
}
