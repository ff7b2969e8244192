//! Files of arrays, variables and JSON that were cut short or changed: one error at most, in bounded time and memory.

mod expected;

use expected::{fixtures, folder, rows};
use servoid_formats::{FormatError, Kind, open};
use std::path::Path;
use std::time::{Duration, Instant};

/// Printed with a case that fails; `SERVOID_SEED` is another one.
const SEED: u64 = 0x5e7_0a11;
/// Cases of each kind for a file; `SERVOID_CASES` is another number.
const CASES: u64 = 100;
/// For one file of some kilobytes, on a busy machine.
const LONGEST: Duration = Duration::from_secs(20);
/// Bytes that may be reserved beyond those at the start.
const MOST_BYTES: u64 = 1 << 30;
/// Tables of a file that are read.
const MOST_TABLES: usize = 30;

fn setting(name: &str, usual: u64) -> u64 {
    let set = std::env::var(name).ok();
    set.and_then(|set| set.parse().ok()).unwrap_or(usual)
}

/// A sequence of numbers that is the same for the same seed (SplitMix64).
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }

    /// Lengths to which a file is cut: all of a short one.
    fn cuts(&mut self, length: usize, cases: u64) -> Vec<usize> {
        if length as u64 <= cases {
            return (0..length).collect();
        }
        (0..cases).map(|_| self.below(length)).collect()
    }

    /// Some bytes changed, as they are when a disk or a line fails.
    fn change(&mut self, bytes: &mut [u8]) {
        for _ in 0..=self.below(5) {
            let at = self.below(bytes.len());
            bytes[at] = match self.below(4) {
                0 => 0,
                1 => 0xff,
                2 => bytes[at] ^ (1 << self.below(8)),
                _ => self.next() as u8,
            };
        }
    }
}

/// Reads all tables of a file; every error has to name it.
fn read(path: &Path) {
    let names_it = |error: &FormatError| {
        assert_eq!(error.source_name, path.display().to_string());
        assert!(error.to_string().starts_with(&error.source_name));
    };
    let mut log = match open(path) {
        Ok(Some(log)) => log,
        Ok(None) => return,
        Err(error) => return names_it(&error),
    };
    let tables = log.tables().to_vec();
    for (at, table) in tables.iter().enumerate().take(MOST_TABLES) {
        let columns = table.columns.iter().enumerate();
        let numeric = columns.filter(|(_, column)| column.kind != Kind::Text);
        let numeric: Vec<usize> = numeric.map(|(at, _)| at).collect();
        match rows(&mut *log, at, &numeric) {
            Err(error) => names_it(&error),
            Ok(columns) => {
                let lengths = columns.iter().map(|column| Some(column.len() as u64));
                assert!(lengths.into_iter().all(|length| length == table.rows));
            }
        }
    }
}

fn reserved() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mut lines = status.lines();
    let peak = lines.find_map(|line| line.strip_prefix("VmPeak:"))?;
    Some(1024 * peak.trim().strip_suffix(" kB")?.parse::<u64>().ok()?)
}

fn holds(format: &str) {
    let seed = setting("SERVOID_SEED", SEED);
    let cases = setting("SERVOID_CASES", CASES);
    let mut sequence = Sequence(seed);
    let scratch = tempfile::tempdir().unwrap();
    let before = reserved();
    for fixture in fixtures(&folder(format)) {
        let name = fixture.file_name().unwrap();
        let damaged = scratch.path().join(name);
        let whole = std::fs::read(&fixture).unwrap();
        let case = |what: &str, bytes: &[u8]| {
            std::fs::write(&damaged, bytes).unwrap();
            // Shown where a case fails.
            println!("{what} of {} with the seed {seed:#x}", name.display());
            let start = Instant::now();
            read(&damaged);
            assert!(start.elapsed() < LONGEST, "it takes {:?}", start.elapsed());
        };
        for cut in sequence.cuts(whole.len(), cases) {
            case(&format!("the first {cut} bytes"), &whole[..cut]);
        }
        for number in 0..cases {
            let mut bytes = whole.clone();
            sequence.change(&mut bytes);
            case(&format!("change {number}"), &bytes);
        }
    }
    if let (Some(before), Some(after)) = (before, reserved()) {
        assert!(after - before < MOST_BYTES, "{} bytes more", after - before);
    }
}

#[test]
fn damaged_arrays_of_numpy_are_one_error() {
    holds("numpy");
}

#[test]
fn damaged_variables_of_matlab_are_one_error() {
    holds("matlab");
}

#[test]
fn damaged_datasets_of_hdf5_are_one_error() {
    holds("hdf5");
}

#[test]
fn damaged_json_is_one_error() {
    holds("json");
}
