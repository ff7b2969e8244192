//! The bring-up image on the bench: its terminal output agrees with the motor's motion.
//!
//! `scripts/rig test` builds the image for each board that runs here and names the folder in `SERVOID_IMAGES`.

use std::env;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

const BOARD: &str = "stm32f427";
const BOARDS: [&str; 4] = ["stm32f405", "stm32f411", "stm32f427", "stm32f446"];

/// RCC_DCKCFGR2, which chooses clocks that our image leaves as they are: the STM32F446 has it, the STM32F427 has not.
const ONLY_F446: &str = "at=0x40023894";

/// A running bench and the terminal on its serial port.
struct Bench {
    process: Child,
    output: BufReader<ChildStdout>,
    terminal: BufReader<TcpStream>,
}

/// A line that the image prints ten times a second.
#[derive(Debug, Clone, PartialEq)]
struct Line {
    count: i64,
    current_ma: i64,
    duty: i64,
    state: String,
}

impl Bench {
    /// A bench that runs for `seconds`, at a pace at which keys arrive in time.
    fn start(board: &str, seconds: f64, flags: &[&str]) -> Self {
        let images = env::var("SERVOID_IMAGES")
            .expect("SERVOID_IMAGES names the folder of images: run scripts/rig test");
        let mut process = Command::new(env!("CARGO_BIN_EXE_servoid-rigless"))
            .arg(format!("{images}/bringup-{board}"))
            .args(["--board", board])
            .args(["--for", &seconds.to_string(), "--pace", "2"])
            .args(flags)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut output = BufReader::new(process.stdout.take().unwrap());
        let mut first = String::new();
        output.read_line(&mut first).unwrap();
        let address = first
            .trim()
            .strip_prefix("link: ")
            .expect("the first line names the port");
        let terminal = BufReader::new(TcpStream::connect(address).unwrap());
        Self {
            process,
            output,
            terminal,
        }
    }

    fn press(&mut self, keys: &str) {
        self.terminal.get_mut().write_all(keys.as_bytes()).unwrap();
    }

    /// The next whole line, or `None` when the bench has ended.
    fn line(&mut self) -> Option<Line> {
        loop {
            let mut text = String::new();
            if self.terminal.read_line(&mut text).ok()? == 0 {
                return None;
            }
            let words: Vec<&str> = text.split_whitespace().collect();
            if let [
                "count",
                count,
                "current",
                current,
                "mA",
                "duty",
                duty,
                ref state @ ..,
            ] = words[..]
            {
                return Some(Line {
                    count: count.parse().unwrap(),
                    current_ma: current.parse().unwrap(),
                    duty: duty.parse().unwrap(),
                    state: state.join(" "),
                });
            }
        }
    }

    /// The next reset that the image says it comes from.
    fn reset(&mut self) -> Option<String> {
        loop {
            let mut text = String::new();
            if self.terminal.read_line(&mut text).ok()? == 0 {
                return None;
            }
            if let Some(reset) = text.trim().strip_prefix("reset: ") {
                return Some(reset.to_owned());
            }
        }
    }

    fn lines(&mut self) -> Vec<Line> {
        std::iter::from_fn(|| self.line()).collect()
    }

    /// The motor's own count at the end, and how often the microcontroller was reset.
    fn end(mut self) -> (i64, i64) {
        let mut report = String::new();
        self.output.read_to_string(&mut report).unwrap();
        assert!(self.process.wait().unwrap().success(), "{report}");
        let gap = |line: &&str| line.contains("the emulator") && !line.contains(ONLY_F446);
        assert_eq!(report.lines().find(gap), None, "{report}");
        assert!(!report.contains("not connected"), "a wrong pin: {report}");
        let number = |name: &str| -> i64 {
            let line = report
                .lines()
                .find_map(|line| line.strip_prefix(name))
                .unwrap();
            line.split_whitespace().next().unwrap().parse().unwrap()
        };
        (number("count "), number("restarts "))
    }
}

#[test]
fn the_printed_count_is_the_motors_and_it_coasts_without_keys() {
    let mut bench = Bench::start(BOARD, 4.0, &[]);
    bench.press("+++++");
    let lines = bench.lines();
    let (count, restarts) = bench.end();
    assert_eq!(restarts, 0);
    let driven: Vec<_> = lines.iter().filter(|line| line.duty != 0).collect();
    assert!(
        (4..=6).contains(&driven.len()),
        "driven for half a second: {lines:?}"
    );
    assert!(
        driven
            .iter()
            .all(|line| line.duty == 5 * 512 && line.state == "ok"),
        "{lines:?}"
    );
    assert!(count > 1000, "it turned forward: {count}");
    assert_eq!(lines.last().unwrap().count, count);
    assert_eq!(lines.last().unwrap().duty, 0);
}

#[test]
fn every_board_drives_its_pins_and_counts_its_encoder() {
    for board in BOARDS {
        let mut bench = Bench::start(board, 2.0, &[]);
        bench.press("++++");
        let lines = bench.lines();
        let (count, _) = bench.end();
        assert!(count > 1000, "{board}: {count}");
        assert_eq!(lines.last().unwrap().count, count, "{board}");
    }
}

#[test]
fn reverse_runs_backwards_through_zero() {
    let mut bench = Bench::start(BOARD, 3.0, &[]);
    bench.press("--------");
    let lines = bench.lines();
    let (count, _) = bench.end();
    assert!(count < -1000, "{count}");
    assert_eq!(lines.last().unwrap().count, count);
}

#[test]
fn the_sensor_shows_the_current_of_a_locked_rotor() {
    let mut bench = Bench::start(BOARD, 2.0, &["--rotor-locked-at", "0"]);
    bench.press("++++");
    let lines = bench.lines();
    let (count, _) = bench.end();
    assert_eq!(count, 0);
    // 24 V through 1.2 ohm, a sixteenth of it.
    let expected = 24.0 / 1.2 / 16.0 * 1000.0;
    let driven: Vec<_> = lines.iter().filter(|line| line.duty == 2048).collect();
    assert!(driven.len() >= 3, "{lines:?}");
    for line in driven {
        assert!(
            (line.current_ma as f64 - expected).abs() < 30.0,
            "{line:?} instead of {expected} mA"
        );
    }
}

#[test]
fn a_fault_of_the_bridge_opens_it_until_the_next_key() {
    for board in BOARDS {
        let mut bench = Bench::start(board, 3.0, &["--bridge-fault-at", "1.0"]);
        let mut lines: Vec<Line> = Vec::new();
        while lines.last().is_none_or(|line| line.state == "ok") {
            bench.press("+");
            lines.push(bench.line().expect("the fault comes after a second"));
        }
        let faulted = lines.last().unwrap();
        let seen = (faulted.duty, faulted.state.as_str());
        assert_eq!(seen, (0, "BRIDGE FAULT"), "{board}");
        bench.press("+");
        let after = bench.lines();
        let drives = after.iter().any(|line| line.duty > 0 && line.state == "ok");
        assert!(drives, "{board}: {after:?}");
        bench.end();
    }
}

#[test]
fn a_reset_while_it_drives_leaves_the_bridge_open() {
    let mut bench = Bench::start(BOARD, 2.0, &["--reset-at", "0.3"]);
    bench.press("++++");
    let lines = bench.lines();
    let (count, restarts) = bench.end();
    assert_eq!(restarts, 1);
    let driven = lines.iter().filter(|line| line.duty != 0).count();
    assert!(
        (1..=3).contains(&driven),
        "not driven after the reset: {lines:?}"
    );
    let last = lines.last().unwrap().count;
    assert!(
        last < count,
        "the count began anew: {last}, the motor's is {count}"
    );
}

#[test]
fn a_reversed_or_stuck_encoder_is_seen_by_the_image() {
    for (flags, expected) in [
        (&["--encoder-reversed"][..], -1),
        (&["--encoder-stuck-at", "0"][..], 0),
    ] {
        let mut bench = Bench::start(BOARD, 2.0, flags);
        bench.press("+++++");
        let lines = bench.lines();
        bench.end();
        assert_eq!(
            lines.last().unwrap().count.signum(),
            expected,
            "{flags:?}: {lines:?}"
        );
    }
}

/// A bench whose bridge is driven when a fault of the microcontroller comes; the time from then to the open bridge, s, and the
/// bench after that.
fn opened_after(board: &str, fault: &str) -> (f64, Bench) {
    const AT: f64 = 0.3;
    let log = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{board}{fault}.csv"));
    let (name, at) = (log.to_str().unwrap(), AT.to_string());
    let mut bench = Bench::start(board, 1.0, &[fault, &at, "--log", name]);
    bench.press("++++");
    let mut output = String::new();
    bench.output.read_to_string(&mut output).unwrap();
    let log = fs::read_to_string(&log).unwrap();
    let states: Vec<(f64, bool)> = log
        .lines()
        .skip(1)
        .map(|line| {
            let mut values = line.split(',');
            let time = values.next().unwrap().parse().unwrap();
            (time, values.next().unwrap() == "open")
        })
        .collect();
    let driven = states.iter().rev().find(|(time, _)| *time < AT);
    assert_eq!(driven.map(|(_, open)| *open), Some(false), "{board}");
    let (opened, _) = states
        .iter()
        .find(|(time, open)| *time >= AT && *open)
        .expect("the bridge opens");
    let stays = states.iter().all(|(time, open)| time < opened || *open);
    assert!(stays, "{board}: it closed again");
    (opened - AT, bench)
}

#[test]
fn the_watchdog_opens_the_bridge_of_a_program_that_does_not_come_back() {
    for board in BOARDS {
        let (after, mut bench) = opened_after(board, "--wedged-at");
        assert!(after < 0.010, "{board}: after {after} s");
        assert_eq!(bench.reset().as_deref(), Some("power-up"), "{board}");
        assert_eq!(bench.reset().as_deref(), Some("watchdog"), "{board}");
    }
}

#[test]
fn a_crystal_that_stops_opens_the_bridge_at_once() {
    for board in BOARDS {
        let (after, _) = opened_after(board, "--crystal-stops-at");
        assert!(after < 0.002, "{board}: after {after} s");
    }
}

#[test]
fn a_program_that_crashes_opens_the_bridge_and_knows_it_when_it_has_started_again() {
    for board in BOARDS {
        let (after, mut bench) = opened_after(board, "--crashes-at");
        assert_eq!(bench.reset().as_deref(), Some("power-up"), "{board}");
        let reset = bench.reset().unwrap_or_default();
        // Where it goes wrong is up to the image: it may also run round in circles.
        match &*reset {
            "panic" | "hard fault" => assert!(after < 0.002, "{board}: after {after} s"),
            "watchdog" => assert!(after < 0.010, "{board}: after {after} s"),
            _ => panic!("{board}: {reset}"),
        }
    }
}
