//! A desk: a folder of its own, in which `servoid` is run as at a shell.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
#[cfg(unix)]
use std::thread::sleep;
#[cfg(unix)]
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

/// The folder; gone with its owner.
pub struct Desk {
    folder: TempDir,
}

/// What a user sees of one run.
pub struct Outcome {
    pub line: String,
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Desk {
    pub fn new() -> Self {
        Desk {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    /// A desk with the recording `rec.csv` of a gearmotor and its `motor.toml`, two seconds long.
    pub fn with_recording() -> Self {
        let desk = Desk::new();
        desk.done("simulate --seconds 2 --out rec.csv");
        desk
    }

    /// A desk with two recordings of one motor by different seeds, `rec.csv` and `other.csv`, as `options` of `simulate` say.
    pub fn with_pair(options: &str) -> Self {
        let desk = Desk::new();
        for (seed, name) in [(1, "rec.csv"), (2, "other.csv")] {
            desk.done(&format!("simulate {options} --seed {seed} --out {name}"));
        }
        desk
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a new folder");
        fs::write(path, content).expect("a new file");
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// A file that a verb wrote with `--json`.
    pub fn read_json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("whole JSON")
    }

    /// How many lines the file has so far; none where there is no such file.
    pub fn lines_of(&self, name: &str) -> usize {
        let text = fs::read_to_string(self.path(name)).unwrap_or_default();
        text.lines().count()
    }

    /// Every file and folder with its length: what must not change when the program refuses.
    pub fn listing(&self) -> BTreeMap<PathBuf, u64> {
        let mut found = BTreeMap::new();
        list(self.folder.path(), &mut found);
        found
    }

    /// The program about to be run here, with the arguments in `line`, which are divided at spaces.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_servoid"));
        command
            .args(line.split_whitespace())
            .current_dir(self.folder.path())
            .stdin(Stdio::null());
        command
    }

    /// The program at work, with both its streams open.
    pub fn spawn(&self, line: &str) -> Child {
        let mut command = self.command(line);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command.spawn().expect("servoid")
    }

    /// The same from a shell that has done `first`.
    #[cfg(unix)]
    pub fn spawn_under(&self, first: &str, line: &str) -> Child {
        let program = env!("CARGO_BIN_EXE_servoid");
        let mut command = Command::new("sh");
        command
            .args(["-c", &format!("{first}; exec {program} {line}")])
            .current_dir(self.folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command.spawn().expect("a shell")
    }

    /// Runs `servoid` with the arguments in `line`.
    pub fn run(&self, line: &str) -> Outcome {
        let output = self.command(line).output().expect("servoid starts");
        Outcome::new(line, output)
    }

    /// Runs what must succeed.
    pub fn done(&self, line: &str) -> Outcome {
        let outcome = self.run(line);
        assert_eq!(outcome.code, Some(0), "{outcome}");
        outcome
    }

    /// Runs what must succeed and returns its JSON, which must be all that is on stdout.
    pub fn json(&self, line: &str) -> Value {
        let outcome = self.done(&format!("{line} --json -"));
        serde_json::from_str(&outcome.stdout)
            .unwrap_or_else(|error| panic!("not JSON alone: {error}\n{outcome}"))
    }

    /// Runs what must be refused: with this exit code, one message that says all of `says`, nothing on
    /// stdout, and no file written or changed.
    pub fn refused(&self, line: &str, code: i32, says: &[&str]) {
        let before = self.listing();
        let outcome = self.run(line);
        outcome.is_refusal(code, says);
        assert_eq!(outcome.stdout, "", "{outcome}");
        assert_eq!(self.listing(), before, "files were left behind\n{outcome}");
    }
}

impl Outcome {
    pub fn new(line: &str, output: Output) -> Self {
        let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
        Outcome {
            line: line.to_owned(),
            code: output.status.code(),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Asserts a failure with this exit code and one message that says all of `says`.
    pub fn is_refusal(&self, code: i32, says: &[&str]) {
        assert_eq!(self.code, Some(code), "{self}");
        assert!(!self.stderr.contains("panicked"), "{self}");
        let starts = |line: &&str| line.starts_with("servoid: ") || line.starts_with("error: ");
        assert_eq!(
            self.stderr.lines().filter(starts).count(),
            1,
            "one message\n{self}"
        );
        for word in says {
            assert!(
                self.stderr.contains(word),
                "the message lacks {word:?}\n{self}"
            );
        }
    }
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "$ servoid {}\nexit code {:?}\n-- stderr\n{}-- stdout\n{}",
            self.line, self.code, self.stderr, self.stdout
        )
    }
}

fn list(folder: &Path, found: &mut BTreeMap<PathBuf, u64>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let entry = entry.expect("an entry");
        let about = entry.metadata().expect("metadata");
        if about.is_dir() {
            list(&entry.path(), found);
        }
        found.insert(entry.path(), about.len());
    }
}

/// Time to end after a signal: generous, against work of hours.
#[cfg(unix)]
pub const PATIENCE: Duration = Duration::from_secs(30);

/// Sends a signal by its name, such as `-INT`.
#[cfg(unix)]
pub fn signal(name: &str, child: &Child) {
    let killed = Command::new("kill")
        .args([name, &child.id().to_string()])
        .status();
    assert!(killed.expect("kill").success());
}

/// What a program at work has left when it has ended, which it must soon.
#[cfg(unix)]
pub fn ended(mut child: Child, line: &str) -> Outcome {
    let asked = Instant::now();
    while child.try_wait().expect("a child").is_none() {
        if asked.elapsed() > PATIENCE {
            child.kill().expect("it can be killed");
            panic!("{line}: does not stop");
        }
        sleep(Duration::from_millis(20));
    }
    Outcome::new(line, child.wait_with_output().expect("servoid ends"))
}
