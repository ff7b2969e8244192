//! Many recordings: the same table however often the work was killed, and however it was divided.

use crate::desk::Desk;
use std::fs;
use std::path::PathBuf;
use std::thread::sleep;
use std::time::Duration;

const FIT: &str = "batch logs --do fit --with coulomb";

/// A desk with a lot: recordings in two folders, one that is cut short, one of no motor, and what is no recording.
fn lot(recordings: usize) -> Desk {
    let desk = Desk::new();
    for seed in 1..=recordings {
        let folder = ["logs", "logs/second"][seed % 2];
        fs::create_dir_all(desk.path(folder)).expect("a folder");
        desk.done(&format!(
            "simulate --seconds 2 --hide coulomb --seed {seed} --out {folder}/unit{seed:02}.csv"
        ));
    }
    let whole = desk.read("logs/unit02.csv");
    desk.write("logs/cut.csv", &whole[..whole.len() / 2]);
    desk.write(
        "logs/still.csv",
        "t_s,voltage_v,angle_counts\n0,1,0\n1,1,0\n2,1,0\n",
    );
    desk.write("logs/words.csv", "no,recording,at all\n1,2,3\n");
    desk.write("logs/notes.txt", "nothing");
    desk
}

fn table(desk: &Desk, name: &str) -> Vec<u8> {
    fs::read(desk.path(name)).expect("a table")
}

fn parts(desk: &Desk, out: &str) -> Vec<PathBuf> {
    let parts = fs::read_dir(desk.path(out).join("parts")).expect("parts");
    parts.map(|part| part.expect("a part").path()).collect()
}

#[test]
fn the_table_is_the_same_however_the_work_is_divided() {
    let desk = lot(7);
    let all = desk.json(&format!("{FIT} --out whole --table whole.parquet"));
    assert_eq!(
        [&all["recordings"], &all["made"], &all["there"]],
        [10, 10, 0]
    );
    assert_eq!(all["rows"]["error: recording"], 3, "{all:#}");
    let again = desk.json(&format!("{FIT} --out whole --table again.parquet"));
    assert_eq!([&again["made"], &again["there"]], [0, 10]);
    assert_eq!(table(&desk, "again.parquet"), table(&desk, "whole.parquet"));
    desk.done(&format!(
        "{FIT} --out alone --workers 1 --table alone.parquet"
    ));
    assert_eq!(table(&desk, "alone.parquet"), table(&desk, "whole.parquet"));
    for shard in [3, 1, 2] {
        desk.done(&format!(
            "{FIT} --out shards --shard {shard}/3 --table shards.parquet"
        ));
    }
    assert_eq!(
        table(&desk, "shards.parquet"),
        table(&desk, "whole.parquet")
    );
    // Errors are done again if asked for; a lot that has grown costs what is new.
    let retried = desk.json(&format!("{FIT} --out whole --retry error"));
    assert_eq!([&retried["made"], &retried["errors"]], [3, 3]);
    desk.done("simulate --seconds 2 --hide coulomb --seed 99 --out logs/new.csv");
    let grown = desk.json(&format!("{FIT} --out whole"));
    assert_eq!([&grown["made"], &grown["there"]], [1, 10]);
    // Another task is another result, beside the first.
    let other = desk.json("batch logs --do fit --out whole");
    assert_eq!(other["made"], 11);
}

#[test]
fn a_killed_run_loses_only_what_was_under_way() {
    let desk = lot(9);
    desk.done(&format!("{FIT} --out whole --table whole.parquet"));
    let command = format!("{FIT} --out killed --table killed.parquet");
    let mut random = 1u64;
    for kill in 0..20 {
        random = random
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        let mut child = desk.command(&command).spawn().expect("it begins");
        sleep(Duration::from_millis(20 + (random >> 32) % 150));
        println!("kill {kill}, seed 1");
        child.kill().expect("killed");
        child.wait().expect("ended");
    }
    let done = desk.json(&command);
    assert_eq!(
        table(&desk, "killed.parquet"),
        table(&desk, "whole.parquet")
    );
    assert_eq!(done["interrupted"], false);
}

#[test]
fn a_damaged_part_is_put_aside_and_its_recordings_are_done_again() {
    let desk = lot(3);
    desk.done(&format!("{FIT} --out results --table whole.parquet"));
    let part = parts(&desk, "results").pop().expect("a part");
    let bytes = fs::read(&part).expect("its bytes");
    for damage in [&bytes[..bytes.len() / 2], b"", b"something else"] {
        for part in parts(&desk, "results") {
            fs::write(part, damage).expect("damaged");
        }
        let outcome = desk.run(&format!("{FIT} --out results --table again.parquet"));
        assert_eq!(outcome.code, Some(0), "{outcome}");
        assert!(outcome.stderr.contains("put aside"), "{outcome}");
        assert_eq!(table(&desk, "again.parquet"), table(&desk, "whole.parquet"));
        for part in parts(&desk, "results") {
            if part.extension().is_some_and(|end| end == "damaged") {
                fs::remove_file(part).expect("removed");
            }
        }
    }
}

#[test]
fn what_cannot_begin_says_why() {
    let desk = lot(2);
    fs::create_dir_all(desk.path("empty")).expect("a folder");
    for (line, code, said) in [
        ("batch empty --out results", 2, "no CSV file"),
        ("batch nothing --out results", 1, "nothing"),
        ("batch logs/notes.txt --out results", 1, "notes.txt"),
        ("batch logs --out logs/notes.txt", 1, "notes.txt"),
        ("batch logs --out results --shard 3/2", 2, "i/n"),
        ("batch logs --out results --with colomb", 2, "colomb"),
        ("batch logs", 2, "--out"),
    ] {
        let outcome = desk.run(line);
        assert_eq!(outcome.code, Some(code), "{outcome}");
        assert!(outcome.stderr.contains(said), "{outcome}");
    }
    assert!(!desk.path("results/parts").exists());
}

/// The examples for Slurm and GNU parallel, with stand-ins for what those say and do.
#[test]
fn a_cluster_does_what_one_machine_does() {
    let desk = lot(5);
    desk.done(&format!("{FIT} --out whole --table whole.parquet"));
    let example = |name: &str| {
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../examples/batch/{name}"))
    };
    let options = ["--do", "fit", "--with", "coulomb"];
    let bash = |script: &str| {
        let mut command = std::process::Command::new("bash");
        command
            .arg(example(script))
            .current_dir(desk.path("."))
            .env("SERVOID", env!("CARGO_BIN_EXE_servoid"));
        command
    };
    // An array that begins with 3, in no order.
    for task in [5, 3, 4] {
        let status = bash("slurm.sh")
            .args(["logs", "slurm"])
            .args(options)
            .env("SLURM_ARRAY_TASK_ID", task.to_string())
            .env("SLURM_ARRAY_TASK_MIN", "3")
            .env("SLURM_ARRAY_TASK_COUNT", "3")
            .env("SLURM_CPUS_PER_TASK", "2")
            .status();
        assert!(status.expect("bash").success());
    }
    let outside = bash("slurm.sh")
        .args(["logs", "slurm"])
        .env_remove("SLURM_ARRAY_TASK_ID")
        .output();
    let outside = outside.expect("bash");
    assert!(!outside.status.success());
    assert!(String::from_utf8_lossy(&outside.stderr).contains("sbatch --array"));
    // GNU parallel runs the command once a line, with the line for {}.
    desk.write(
        "bin/parallel",
        "#!/usr/bin/env bash\nshift 2\nwhile read -r line; do \"${@//\\{\\}/$line}\"; done\n",
    );
    let path = format!(
        "{}:{}",
        desk.path("bin").display(),
        std::env::var("PATH").expect("a PATH")
    );
    let made = std::process::Command::new("chmod")
        .arg("+x")
        .arg(desk.path("bin/parallel"))
        .status();
    assert!(made.expect("chmod").success());
    let status = bash("parallel.sh")
        .args(["4", "logs", "parallel"])
        .args(options)
        .env("PATH", path)
        .status();
    assert!(status.expect("bash").success());
    for out in ["slurm", "parallel"] {
        desk.done(&format!("{FIT} --out {out} --table {out}.parquet"));
        assert_eq!(
            table(&desk, &format!("{out}.parquet")),
            table(&desk, "whole.parquet")
        );
        let again = desk.json(&format!("{FIT} --out {out}"));
        assert_eq!(again["made"], 0);
    }
}
