//! The same bytes from processors with other instructions: the program under an emulated one without AVX and fused multiply-add.

use super::desk::Desk;
use std::process::Command;
use testing::left_out::tool;

/// An x86-64 processor of 2008: SSE4.2, no AVX, no fused multiply-add.
const OLD: &str = "Nehalem";

/// Runs the program as an old processor does.
fn emulated(desk: &Desk, mut emulator: Command, line: &str) {
    let native = desk.command(line);
    emulator
        .args(["-cpu", OLD])
        .arg(native.get_program())
        .args(native.get_args());
    if let Some(folder) = native.get_current_dir() {
        emulator.current_dir(folder);
    }
    let output = emulator.output().expect("the emulator runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
#[test]
fn an_old_processor_gives_the_same_bytes() {
    if tool("qemu-x86_64").is_none() {
        return;
    }
    let desk = Desk::new();
    desk.done("simulate --hide coulomb --hide cogging --seconds 1.5 --seed 3 --out rec.csv");
    let lines = [
        "fit rec.csv --with coulomb --budget 400 --json JSON",
        "fit rec.csv --algorithm cmaes --budget 300 --json JSON",
        "fit rec.csv --algorithm ga --cost iae-floored --budget 300 --json JSON",
        "fit rec.csv --with coulomb --cost interval --budget 200 --json JSON",
    ];
    let few = testing::length::cases(lines.len(), 2);
    for line in &lines[..few] {
        desk.done(&line.replace("JSON", "native.json"));
        let emulator = tool("qemu-x86_64").expect("it was there");
        emulated(&desk, emulator, &line.replace("JSON", "emulated.json"));
        let told = |name: &str| desk.read(name).replace(name, "");
        assert!(
            told("native.json") == told("emulated.json"),
            "{line}: other bytes"
        );
    }
}

/// A lot's table, too: fits and diagnoses.
#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
#[test]
fn a_batch_gives_the_same_table_on_an_old_processor() {
    if tool("qemu-x86_64").is_none() {
        return;
    }
    let desk = Desk::new();
    std::fs::create_dir(desk.path("lot")).expect("a folder");
    for seed in 1..=3 {
        desk.done(&format!(
            "simulate --seconds 1.5 --hide coulomb --seed {seed} --out lot/{seed}.csv"
        ));
    }
    let tasks = ["fit --with coulomb", "diagnose"];
    for (k, task) in tasks.iter().enumerate().take(testing::length::cases(2, 1)) {
        let line = format!("batch lot --do {task} --out OUT{k} --table OUT{k}.parquet");
        desk.done(&line.replace("OUT", "native"));
        let emulator = tool("qemu-x86_64").expect("it was there");
        emulated(&desk, emulator, &line.replace("OUT", "emulated"));
        let table =
            |name: &str| std::fs::read(desk.path(&format!("{name}{k}.parquet"))).expect("a table");
        assert!(table("native") == table("emulated"), "{task}: other bytes");
    }
}
