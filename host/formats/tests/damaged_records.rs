//! Files of records and of Parquet that were cut short or changed: one error at most, in bounded time and memory.

mod read;

use read::{fixture, numeric, rows};
use servoid_formats::open;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const SEED: u64 = 0x5e27_01d0;
/// Cases of each kind for a file.
const CASES: usize = 150;
/// For one file of some kilobytes, on a busy machine.
const LONGEST: Duration = Duration::from_secs(20);
/// Bytes that may be reserved beyond those at the start.
const MOST_BYTES: u64 = 1 << 30;

/// Numbers that are the same in each run.
struct Seeded(u64);

impl Seeded {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }
}

fn files(folder: &Path, out: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            files(&entry, out);
        } else {
            out.push(entry);
        }
    }
}

/// Reads all that is in a log; errors must name one of its files.
fn read_all(log: &Path) {
    let name = log.display().to_string();
    let named = |error: servoid_formats::FormatError| {
        assert!(error.source_name.starts_with(&name), "{error}");
        assert!(!error.to_string().is_empty());
    };
    let mut found = match open(log) {
        Ok(Some(found)) => found,
        Ok(None) => return,
        Err(error) => return named(error),
    };
    for table in 0..found.tables().len().min(20) {
        let columns = numeric(&found.tables()[table]);
        if let Err(error) = rows(&mut *found, table, &columns).1 {
            named(error);
        }
    }
}

/// The law for one file of a log, which is written to `target` with some damage.
fn holds(log: &Path, target: &Path, whole: &[u8]) {
    let mut seeded = Seeded(SEED);
    let case = |what: &str, bytes: &[u8]| {
        std::fs::write(target, bytes).unwrap();
        let start = Instant::now();
        let ended = catch_unwind(AssertUnwindSafe(|| read_all(log)));
        let kept = std::env::temp_dir().join("servoid_formats_damaged");
        if ended.is_err() || start.elapsed() > LONGEST {
            std::fs::write(&kept, bytes).unwrap();
        }
        assert!(
            ended.is_ok(),
            "{what} of {}, kept as {}",
            target.display(),
            kept.display()
        );
        assert!(
            start.elapsed() < LONGEST,
            "{what} of {} takes for ever",
            target.display()
        );
    };
    let all = whole.len() <= 2 * CASES;
    for cut in 0..if all { whole.len() } else { CASES } {
        let cut = if all || cut < 40 {
            cut
        } else {
            seeded.below(whole.len())
        };
        case(&format!("the first {cut} bytes"), &whole[..cut]);
    }
    for number in 0..CASES {
        let mut bytes = whole.to_vec();
        for _ in 0..=seeded.below(6) {
            let at = seeded.below(bytes.len());
            bytes[at] = match seeded.below(4) {
                0 => 0xff,
                1 => bytes[at] ^ (1 << seeded.below(8)),
                _ => seeded.below(256) as u8,
            };
        }
        case(&format!("case {number} of the seed {SEED:#x}"), &bytes);
    }
    std::fs::write(target, whole).unwrap();
}

/// The most bytes that this process ever reserved, where the system says it.
fn reserved() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmPeak:"))?;
    Some(1024 * line.split_whitespace().next()?.parse::<u64>().ok()?)
}

#[test]
fn damaged_files_are_one_error_in_bounded_time_and_memory() {
    let before = reserved();
    let folder = tempfile::tempdir().unwrap();
    for format in ["mcap", "wpilog", "parquet"] {
        let mut found = Vec::new();
        files(&fixture(format), &mut found);
        for path in found {
            let target = folder.path().join(path.file_name().unwrap());
            holds(&target, &target, &std::fs::read(&path).unwrap());
        }
    }
    for version in ["v3", "v21"] {
        let from = fixture("lerobot").join(version);
        let to = folder.path().join(version);
        let mut found = Vec::new();
        files(&from, &mut found);
        for path in &found {
            let target = to.join(path.strip_prefix(&from).unwrap());
            std::fs::create_dir_all(target.parent().unwrap()).unwrap();
            std::fs::copy(path, &target).unwrap();
        }
        for path in &found {
            let target = to.join(path.strip_prefix(&from).unwrap());
            holds(&to, &target, &std::fs::read(path).unwrap());
        }
    }
    if let (Some(before), Some(after)) = (before, reserved()) {
        assert!(
            after - before < MOST_BYTES,
            "{} bytes were reserved",
            after - before
        );
    }
}
