//! A run of a device whose program is stopped: asked to by a signal it keeps the recording; killed, it leaves what had arrived.
#![cfg(unix)]

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Child;
use std::thread::{self, sleep};
use std::time::{Duration, Instant};

use shared::wire::*;

use crate::desk::{Desk, PATIENCE, ended, signal};

const NONCE: u32 = 9;

/// A device that records for ever, until it is told to stop; its port.
fn recording() -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    thread::spawn(move || {
        let (stream, _) = listener.accept().unwrap();
        let _ = serve(stream);
    });
    port
}

fn serve(mut stream: TcpStream) -> std::io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_millis(5)))?;
    let (mut inbox, mut buffer) = (Deframer::new(), [0; 256]);
    let (mut runs, mut first) = (false, 0);
    loop {
        let read = stream.read(&mut buffer).unwrap_or(0);
        for &byte in &buffer[..read] {
            let answer = match inbox.push::<ToDevice>(byte) {
                Some(ToDevice::Hello) => ToHost::About(about()),
                Some(ToDevice::Arm) => ToHost::Armed {
                    nonce: NONCE,
                    periods: 5000,
                },
                Some(ToDevice::Start { .. }) => {
                    runs = true;
                    ToHost::Started { run: NONCE }
                }
                Some(ToDevice::Stop) => ToHost::Failed(Failure {
                    run: NONCE,
                    fault: Fault::Stopped,
                    stage: Stage::Excite,
                    at: first,
                    seen: 0,
                    limit: 0,
                    report: None,
                }),
                _ => continue,
            };
            runs &= !matches!(answer, ToHost::Failed(_));
            send(&mut stream, &answer)?;
        }
        if runs {
            let row = Row {
                duty: 1000,
                step: 3,
                current_ma: 100,
                supply_mv: 0,
            };
            let rows = Rows {
                run: NONCE,
                stage: Stage::Excite,
                first,
                count: 3 * first as i32,
                rows: [row; 8].into_iter().collect(),
            };
            first += 8;
            send(&mut stream, &ToHost::Rows(rows))?;
        }
    }
}

fn send(stream: &mut TcpStream, message: &ToHost) -> std::io::Result<()> {
    let mut buffer = [0; LONGEST_FRAME];
    stream.write_all(encode(message, &mut buffer).unwrap())
}

fn about() -> About {
    About {
        version: VERSION,
        board: "drip".try_into().unwrap(),
        firmware: "0".try_into().unwrap(),
        period_us: 1000,
        capacity: 2000,
        format: Format::F32,
        senses_current: true,
        boot: 1,
        stage: Stage::Idle,
        full: 32_768,
    }
}

/// A recording under way into the folder `run`, of which two seconds have arrived.
fn under_way(desk: &Desk, spawn: impl FnOnce(&str) -> Child) -> (Child, String) {
    let line = format!(
        "device record --port tcp:127.0.0.1:{} --supply-v 12 --counts-per-rev 2000 --seconds 3000 --out run",
        recording()
    );
    let mut child = spawn(&line);
    let asked = Instant::now();
    while desk.lines_of("run/recording.unfinished.csv") < 2000 {
        assert!(asked.elapsed() < PATIENCE, "nothing is written");
        assert!(child.try_wait().unwrap().is_none(), "it ended");
        sleep(Duration::from_millis(20));
    }
    (child, line)
}

#[test]
fn a_terminal_that_closes_and_a_manager_that_terminates_keep_the_recording_as_ctrl_c_does() {
    for name in ["-INT", "-TERM", "-HUP"] {
        let desk = Desk::new();
        let (child, line) = under_way(&desk, |line| desk.spawn(line));
        signal(name, &child);
        let outcome = ended(child, &line);
        assert_eq!(outcome.code, Some(1), "{name}: {outcome}");
        assert!(desk.lines_of("run/recording.csv") > 2000, "{name}");
        assert_eq!(desk.read_json("run/device.json")["partial"], true);
        assert_eq!(
            desk.read_json("run/device.json")["failure"]["fault"],
            "Stopped"
        );
        assert_eq!(desk.lines_of("run/recording.unfinished.csv"), 0, "{name}");
    }
}

#[test]
fn under_nohup_a_closed_terminal_stops_nothing() {
    let desk = Desk::new();
    let (child, line) = under_way(&desk, |line| desk.spawn_under("trap '' HUP", line));
    signal("-HUP", &child);
    let before = desk.lines_of("run/recording.unfinished.csv");
    let asked = Instant::now();
    while desk.lines_of("run/recording.unfinished.csv") < before + 500 {
        assert!(asked.elapsed() < PATIENCE, "it goes on");
        sleep(Duration::from_millis(20));
    }
    signal("-TERM", &child);
    assert_eq!(ended(child, &line).code, Some(1));
}

#[test]
fn a_program_that_is_killed_leaves_what_had_arrived_for_any_verb_to_read() {
    let desk = Desk::new();
    let (child, line) = under_way(&desk, |line| desk.spawn(line));
    signal("-KILL", &child);
    assert_eq!(ended(child, &line).code, None);
    let check =
        desk.run("check run/recording.unfinished.csv --motor run/motor.toml --json check.json");
    assert!(check.stdout.contains("recording"), "{check}");
    assert!(
        desk.read("run/recording.unfinished.csv")
            .starts_with("# unfinished")
    );
    // What it left is not overwritten.
    let again = desk.run(&line);
    again.is_refusal(1, &["recording.unfinished.csv", "name another folder"]);
}
