//! The path of a user without hardware, end to end: the firmware's application on a PC, the virtual bench as its motor, and
//! the command line that talks to it.

use clap::Parser;
use firmware::app::{App, Memory, Recording};
use firmware::board::pc::Pc;
use host::cli::Cli;
use serde_json::Value;
use servoid_plant::{Bench, Hidden, Machine};
use std::fs;
use std::net::{Ipv4Addr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

const COUNTS_PER_REV: u32 = 2000;
/// Above real time: the host must still be in time, with its twenty milliseconds between two signs of life. The device waits for half a
/// simulated second, so that a busy machine has a quarter of a second to let the host's thread run.
const PACE: f64 = 2.0;

/// A device on a thread of its own; it ends with this value.
struct Device {
    port: String,
    end: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Device {
    fn with(hide: &[&str]) -> Self {
        Device::of(Machine::gearmotor(), hide, None)
    }

    /// With a file that outlives it, as a flash.
    fn of(machine: Machine, hide: &[&str], flash: Option<&Path>) -> Self {
        let mut bench = Bench::new(machine);
        bench.effects = hide
            .iter()
            .map(|text| Hidden::parse(text, &machine).unwrap())
            .collect();
        bench.counts_per_rev = COUNTS_PER_REV;
        let (plant, _) = host::device::plant(bench, PACE).unwrap();
        let free = TcpListener::bind((Ipv4Addr::LOCALHOST, 0))
            .unwrap()
            .local_addr()
            .unwrap();
        let end = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&end);
        let board = Pc::start(&free.to_string(), &plant.to_string()).unwrap();
        let board = match flash {
            Some(file) => board.with_flash(file.to_owned()),
            None => board,
        };
        let thread = thread::spawn(move || {
            let mut memory = Box::new(Memory::<f32>::new());
            let mut recording = Box::new(Recording::<2000>::new());
            let mut app = App::new(board, &mut memory, &mut recording);
            while !app.board().is_gone() && !flag.load(Ordering::Relaxed) {
                app.period();
            }
        });
        Device {
            port: format!("tcp:{free}"),
            end,
            thread: Some(thread),
        }
    }

    /// The flags that name it, and what is known of its bench.
    fn bench(&self) -> impl Iterator<Item = &str> {
        "--supply-v 12 --counts-per-rev 2000 --port"
            .split(' ')
            .chain([self.port.as_str()])
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        self.end.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().expect("the application does not panic");
        }
    }
}

/// Runs a command line; gives its JSON, and the error if there was one.
fn servoid(words: &[&str], json: &Path) -> (Option<Value>, Option<String>) {
    let mut line = vec!["servoid"];
    line.extend(words);
    let json_text = json.display().to_string();
    line.extend(["--json", &json_text, "--quiet"]);
    let cli = Cli::try_parse_from(line).unwrap_or_else(|error| panic!("{error}"));
    let error = host::cmd::run(cli).err().map(|error| error.to_string());
    let value = fs::read_to_string(json)
        .ok()
        .and_then(|text| serde_json::from_str(&text).ok());
    (value, error)
}

fn commission(device: &Device, out: &Path, more: &[&str]) -> (Option<Value>, Option<String>) {
    identify("commission", device, out, more)
}

fn identify(
    verb: &str,
    device: &Device,
    out: &Path,
    more: &[&str],
) -> (Option<Value>, Option<String>) {
    let out_text = out.display().to_string();
    let mut words = vec!["device", verb, "--out", &out_text];
    words.extend(device.bench());
    words.extend(more);
    servoid(&words, &out.with_extension("commission.json"))
}

fn verify(out: &Path) -> Value {
    let (json, error) = servoid(
        &["device", "verify", &out.display().to_string()],
        &out.with_extension("verify.json"),
    );
    assert_eq!(error, None);
    json.expect("a verdict")
}

#[test]
fn a_motor_with_friction_commissions_itself_and_its_answer_stands() {
    let folder = tempfile::tempdir().unwrap();
    for (name, algorithm) in [("fireflies", "firefly"), ("swarm", "pso")] {
        let device = Device::with(&["coulomb"]);
        let out = folder.path().join(name);
        let (saved, error) = commission(
            &device,
            &out,
            &["--algorithm", algorithm, "--verify-within", "0.5"],
        );
        assert_eq!(error, None);
        let saved = saved.unwrap();
        assert_eq!(saved["partial"], false, "{saved}");
        assert!(
            saved["verified_rms_counts"].as_f64().unwrap() < 0.4,
            "{saved}"
        );
        let verdict = verify(&out);
        assert_eq!(verdict["same_bits"], true, "{verdict}");
        assert_eq!(verdict["stands"], true, "{}", verdict["verdict"]);
    }
}

#[test]
fn a_motor_makes_a_servo_of_itself_and_its_gains_go_where_they_are_good() {
    let folder = tempfile::tempdir().unwrap();
    let device = Device::with(&["coulomb"]);
    let out = folder.path().join("servo");
    let (saved, error) = identify("tune", &device, &out, &["--excite", "0"]);
    assert_eq!(error, None);
    let mut saved = saved.unwrap();
    assert_eq!(saved["grade"], "floor", "{saved}");
    let tuned = saved["tuned"].clone();
    let of = |who: &str, what: &str| tuned[who][what].as_f64().unwrap();
    let slower = of("measured", "settling_s") / of("predicted", "settling_s");
    assert!((0.85..1.15).contains(&slower), "{tuned}");
    assert!(
        of("measured", "overshoot") < of("predicted", "overshoot") + 0.15,
        "{tuned}"
    );
    assert!(of("measured", "left_counts").abs() <= 2.0, "{tuned}");
    assert!(out.join("tune.csv").exists());
    // The device keeps its servo, and follows a table of set-points.
    let course = folder.path().join("course.csv");
    fs::write(&course, "t_s,angle_rad\n0,6\n0.6,-3\n1.2,1\n").unwrap();
    let course = course.display().to_string();
    let (followed, error) = identify(
        "follow",
        &device,
        &out.with_extension("followed"),
        &[&course],
    );
    assert_eq!(error, None);
    let reached = followed.unwrap()["followed"]["reached"].as_f64().unwrap();
    assert!((reached - 1.0).abs() < 0.02, "{reached}");
    // Of a motor that is good for nothing no gains are computed, unless they are asked for with force.
    let out_text = out.display().to_string();
    let export = |more: &[&str]| {
        let words = ["export", &out_text, "--to", "gains"];
        servoid(&[&words, more].concat(), &out.with_extension("gains.json"))
    };
    let (written, error) = export(&[]);
    assert_eq!(error, None);
    let head = written.unwrap()["text"].to_string();
    assert!(head.contains("verified") && !head.contains("NOT"), "{head}");
    saved["grade"] = "no".into();
    saved["reason"] = "too coarse".into();
    fs::write(out.join("device.json"), saved.to_string()).unwrap();
    let error = export(&[]).1.expect("refused");
    assert!(
        error.contains("too coarse") && error.contains("--force"),
        "{error}"
    );
    let (written, error) = export(&["--force"]);
    assert_eq!(error, None);
    let head = written.unwrap()["text"].to_string();
    assert!(head.contains("NOT VERIFIED: too coarse"), "{head}");
}

#[test]
fn a_servo_outlives_a_power_cut_and_another_motor_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let flash = folder.path().join("flash");
    let info = |device: &Device| {
        let json = folder.path().join("info.json");
        let (about, error) = servoid(&["device", "info", "--port", &device.port], &json);
        assert_eq!(error, None);
        about.unwrap()["servo"].clone()
    };
    let device = Device::of(Machine::gearmotor(), &[], Some(&flash));
    assert_eq!(info(&device), "none");
    let (saved, error) = identify(
        "tune",
        &device,
        &folder.path().join("servo"),
        &["--excite", "0"],
    );
    assert_eq!(error, None);
    assert_eq!(saved.unwrap()["tuned"]["kept"], true);
    drop(device);
    let again = Device::of(Machine::gearmotor(), &[], Some(&flash));
    assert_eq!(info(&again), "untried");
    let follow = |device: &Device, name: &str| {
        let out = folder.path().join(name);
        identify("follow", device, &out, &["--angle", "3", "--for", "1"])
    };
    let (followed, error) = follow(&again, "again");
    assert_eq!(error, None);
    let followed = followed.unwrap();
    let reached = followed["followed"]["reached"].as_f64().unwrap();
    assert!((reached - 3.0).abs() < 0.02, "{reached}");
    let changed = followed["predicted"]["gain_moved"].as_f64().unwrap();
    assert!(changed.abs() < 0.02, "{changed}");
    assert_eq!(info(&again), "tried");
    drop(again);
    let mut heavier = Machine::gearmotor();
    heavier.inertia_kg_m2 *= 3.0;
    let other = Device::of(heavier, &[], Some(&flash));
    let (_, error) = follow(&other, "other");
    let error = error.expect("another motor");
    assert!(
        error.contains("not the one whose servo was kept") && error.contains("percent"),
        "{error}"
    );
    // A flash that holds something else holds no servo.
    fs::write(&flash, [1, 2, 3]).unwrap();
    let (_, error) = follow(
        &Device::of(Machine::gearmotor(), &[], Some(&flash)),
        "nothing",
    );
    assert!(error.expect("no servo").contains("servoid device tune"));
}

#[test]
fn a_hidden_effect_is_named_by_the_host_and_the_error_falls() {
    let folder = tempfile::tempdir().unwrap();
    let device = Device::with(&["cogging"]);
    let out = folder.path().join("cogging");
    // The device says that its model lacks something, and what it is good for all the same.
    let (saved, error) = commission(&device, &out, &[]);
    assert_eq!(error, None);
    let saved = saved.unwrap();
    assert_eq!(saved["grade"], "control", "{saved}");
    assert!(saved["reason"].as_str().unwrap().contains("device verify"));
    // Who wants it to the count is told that it is not.
    let strict = folder.path().join("strict");
    let (saved, error) = commission(&device, &strict, &["--verify-within", "1"]);
    let error = error.expect("not verified");
    assert!(error.contains("not verified"), "{error}");
    assert_eq!(saved.unwrap()["partial"], false);
    let verdict = verify(&out);
    assert_eq!(verdict["same_bits"], true);
    assert_eq!(verdict["stands"], false);
    let diagnosis = &verdict["diagnosis"];
    assert_eq!(
        diagnosis["final"]["effects"],
        serde_json::json!(["cogging"]),
        "{}",
        verdict["verdict"]
    );
    let error = |of: &str| diagnosis[of]["validate_rms_counts"].as_f64().unwrap();
    assert!(
        error("base") > 8.0 * error("final"),
        "{} {}",
        error("base"),
        error("final")
    );
}

#[test]
fn a_changed_recording_is_found_out() {
    let folder = tempfile::tempdir().unwrap();
    let device = Device::with(&[]);
    let out = folder.path().join("run");
    let (_, error) = commission(&device, &out, &["--excite", "0"]);
    assert_eq!(error, None);
    assert_eq!(verify(&out)["same_bits"], true);
    let path = out.join("fitted.csv");
    let text = fs::read_to_string(&path).unwrap();
    // One count less from the middle on.
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let middle = lines.len() / 2;
    for line in &mut lines[middle..] {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        cells[2] = (cells[2].parse::<i64>().unwrap() - 1).to_string();
        *line = cells.join(",");
    }
    fs::write(&path, lines.join("\n") + "\n").unwrap();
    let (json, error) = servoid(
        &["device", "verify", &out.display().to_string()],
        &out.with_extension("again.json"),
    );
    assert_eq!(json.unwrap()["same_bits"], false);
    assert!(error.unwrap().contains("does not find the device's bits"));
}

#[test]
fn limits_and_a_folder_in_use_are_told_with_their_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let device = Device::with(&[]);
    let out = folder.path().join("travel");
    let (saved, error) = commission(&device, &out, &["--max-travel", "0.5"]);
    let error = error.expect("half a turn is not enough");
    assert!(
        error.contains("left its allowed travel") && error.contains("limit 1000"),
        "{error}"
    );
    assert_eq!(saved.unwrap()["failure"]["fault"], "Overtravel");
    let (_, error) = commission(&device, &out, &[]);
    assert!(error.unwrap().contains("holds a run already"));
    let (_, error) = commission(&device, &folder.path().join("odd"), &["--max-current", "0"]);
    assert!(error.unwrap().contains("--max-current 0"));
}

#[test]
fn a_plan_is_played_as_written() {
    let folder = tempfile::tempdir().unwrap();
    let plan = folder.path().join("plan.csv");
    fs::write(
        &plan,
        "t_s,voltage_v,enabled\n0,0,1\n0.1,6,1\n0.4,-6,1\n0.7,0,0\n1.0,0,0\n",
    )
    .unwrap();
    let device = Device::with(&[]);
    let out = folder.path().join("played");
    let (plan_text, out_text) = (plan.display().to_string(), out.display().to_string());
    let mut words = vec!["device", "run", &plan_text, "--out", &out_text];
    words.extend(device.bench());
    let (_, error) = servoid(&words, &folder.path().join("played.json"));
    assert_eq!(error, None);
    let text = fs::read_to_string(out.join("recording.csv")).unwrap();
    let rows: Vec<Vec<f64>> = text
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()))
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len(), 1301);
    for (at, volts, enabled) in [
        (50, 0.0, 1.0),
        (200, 6.0, 1.0),
        (500, -6.0, 1.0),
        (900, 0.0, 0.0),
    ] {
        let row = &rows[at];
        assert!((row[1] - volts).abs() < 1e-3, "{row:?}");
        assert_eq!(row.last(), Some(&enabled), "{row:?}");
    }
    assert!(rows[400][2] > rows[100][2] + 100.0, "it turned");
}
