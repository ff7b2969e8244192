//! Files that were cut short or changed: one error at most, in bounded time and memory, and never a panic.
//!
//! `SERVOID_CASES` is how many cases are tried of each kind for a file, and `SERVOID_SEED` another seed. For a long run:
//!
//! ```sh
//! TMPDIR=/dev/shm SERVOID_CASES=100000 cargo test --release -p servoid-formats --test damaged -- --nocapture
//! ```

mod damage;
mod read;

use damage::{Sequence, damage, laid_bare};
use read::{fixture, numeric};
use servoid_formats::{Format, FormatError, decompressed, open};
use std::io::Read;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use testing::length::{cases, fuzzed, setting};

const SEED: u64 = 0x5e70_1d0a;
/// For one file of some kilobytes, on a busy machine.
const LONGEST: Duration = Duration::from_secs(20);
/// Bytes that may be reserved beyond those at the start.
const MOST_BYTES: u64 = 256 << 20;
/// Tables of a file that are read.
const MOST_TABLES: usize = 30;
/// Numbers of a file that are read, a damaged one may truly hold more: what repeats takes no room.
const MOST_NUMBERS: usize = 1 << 22;
/// Cases that fail until a file is given up.
const MOST_FAILURES: usize = 5;

/// All files of a folder that are fixtures.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut entries: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    let mut found = Vec::new();
    for entry in entries {
        if entry.is_dir() {
            found.extend(files(&entry));
        } else if !entry.ends_with("expected.json") {
            found.push(entry);
        }
    }
    found
}

/// Reads all that is in a log; every error has to name it.
fn read_all(log: &Path) {
    let name = log.display().to_string();
    let names_it = |error: FormatError| {
        assert!(error.source_name.starts_with(&name), "{error}");
        assert!(error.to_string().starts_with(&error.source_name));
    };
    let mut found = match open(log) {
        Ok(Some(found)) => found,
        Ok(None) => return read_text(log),
        Err(error) => return names_it(error),
    };
    let mut left = MOST_NUMBERS;
    for table in 0..found.tables().len().min(MOST_TABLES) {
        let columns = numeric(&found.tables()[table]);
        // What the statistics of an MCAP file say is told, and nothing rests on it.
        let is_sure = found.format() != Format::Mcap;
        let wanted = found.tables()[table].rows.filter(|_| is_sure);
        let mut rows = 0u64;
        let mut broken = false;
        let read = found.read(table, &columns, &mut |some| {
            assert_eq!(some.len(), columns.len());
            let length = some.first().map_or(0, Vec::len);
            assert!(some.iter().all(|column| column.len() == length));
            rows += length as u64;
            left = left.saturating_sub(length * some.len());
            broken = left == 0;
            if broken {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        match read {
            Err(error) => names_it(error),
            Ok(()) if broken => return,
            Ok(()) => assert!(
                columns.is_empty() || wanted.is_none_or(|wanted| wanted == rows),
                "table {table} has {rows} rows and not {wanted:?}"
            ),
        }
    }
}

/// Reads what is no log as a text that may be compressed.
fn read_text(path: &Path) {
    if let Ok(text) = decompressed(path) {
        let mut text = text.take(8 * MOST_NUMBERS as u64);
        let _ = std::io::copy(&mut text, &mut std::io::sink());
    }
}

/// The most bytes that this process ever reserved, where the system says it.
fn reserved() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let mut lines = status.lines();
    let peak = lines.find_map(|line| line.strip_prefix("VmPeak:"))?;
    Some(1024 * peak.split_whitespace().next()?.parse::<u64>().ok()?)
}

/// One file of a log: the file to be damaged, the log that it belongs to, and others of its format.
struct Law<'l> {
    log: &'l Path,
    target: &'l Path,
    others: &'l [Vec<u8>],
    before: Option<u64>,
    tried: u64,
    longest: Duration,
    failures: Vec<String>,
}

impl Law<'_> {
    fn case(&mut self, what: &str, bytes: &[u8]) {
        std::fs::write(self.target, bytes).unwrap();
        let start = Instant::now();
        let ended = catch_unwind(AssertUnwindSafe(|| read_all(self.log)));
        let took = start.elapsed();
        self.tried += 1;
        self.longest = self.longest.max(took);
        let more = self.before.zip(reserved());
        let more = more.map_or(0, |(before, after)| after.saturating_sub(before));
        let fault = match ended {
            Err(_) => "it panics".to_owned(),
            Ok(()) if took > LONGEST => format!("it takes {took:?}"),
            Ok(()) if more > MOST_BYTES => format!("{more} bytes more are reserved"),
            Ok(()) => return,
        };
        // The peak never falls again.
        self.before = reserved();
        let name = self.target.file_name().unwrap().to_str().unwrap();
        let number = self.failures.len();
        let kept = std::env::temp_dir().join(format!("servoid_damaged_{number}_{name}"));
        std::fs::write(&kept, bytes).unwrap();
        let failure = format!("{what} of {name}, kept as {}: {fault}", kept.display());
        println!("{failure}");
        self.failures.push(failure);
    }

    /// Tries `whole` cut short and changed, `count` times each.
    fn holds(&mut self, whole: &[u8], seed: u64, count: u64) {
        let mut cuts: Vec<usize> = (0..whole.len()).collect();
        if whole.len() as u64 > count {
            let mut sequence = Sequence::new(seed);
            cuts = (0..count).map(|_| sequence.below(whole.len())).collect();
        }
        for cut in cuts {
            self.case(&format!("the first {cut} bytes"), &whole[..cut]);
        }
        let is_text = std::str::from_utf8(whole).is_ok();
        let bare = laid_bare(whole);
        for number in 0..count {
            if self.failures.len() >= MOST_FAILURES {
                break;
            }
            let mut sequence = Sequence::new(seed ^ number.wrapping_mul(0xd134_2543_de82_ef95));
            let from = match &bare {
                Some(bare) if number % 2 == 1 => bare,
                _ => whole,
            };
            let mut bytes = from.to_vec();
            let other = &self.others[sequence.below(self.others.len())];
            damage(&mut sequence, &mut bytes, other, is_text);
            self.case(&format!("case {number} of the seed {seed:#x}"), &bytes);
        }
        std::fs::write(self.target, whole).unwrap();
    }
}

/// The law for all fixtures of a format; those of a `dataset` are files of one log.
fn holds(format: &str, dataset: bool) {
    let seed = setting("SERVOID_SEED").unwrap_or(SEED);
    let count = fuzzed(cases(2_000, 400));
    let from = fixture(format);
    let found = files(&from);
    let contents: Vec<Vec<u8>> = found.iter().map(|p| std::fs::read(p).unwrap()).collect();
    let scratch = tempfile::tempdir().unwrap();
    let targets: Vec<PathBuf> = found
        .iter()
        .map(|path| scratch.path().join(path.strip_prefix(&from).unwrap()))
        .collect();
    for (target, content) in targets.iter().zip(&contents) {
        std::fs::create_dir_all(target.parent().unwrap()).unwrap();
        std::fs::write(target, content).unwrap();
    }
    let mut failures = Vec::new();
    let (mut tried, mut longest) = (0, Duration::ZERO);
    for (target, content) in targets.iter().zip(&contents) {
        let mut law = Law {
            log: if dataset { scratch.path() } else { target },
            target,
            others: &contents,
            before: reserved(),
            tried: 0,
            longest: Duration::ZERO,
            failures: Vec::new(),
        };
        law.holds(content, seed, count);
        tried += law.tried;
        longest = longest.max(law.longest);
        failures.extend(law.failures);
    }
    println!("{format}: {tried} files, the slowest in {longest:?}");
    assert!(failures.is_empty(), "{failures:#?}");
}

macro_rules! laws {
    ($($name:ident: $format:literal, $dataset:literal;)*) => {
        $(#[test]
        fn $name() {
            holds($format, $dataset);
        })*
    };
}

laws! {
    damaged_arrays_of_numpy_are_one_error: "numpy", false;
    damaged_variables_of_matlab_are_one_error: "matlab", false;
    damaged_datasets_of_hdf5_are_one_error: "hdf5", false;
    damaged_json_is_one_error: "json", false;
    damaged_messages_of_mcap_are_one_error: "mcap", false;
    damaged_records_of_wpilog_are_one_error: "wpilog", false;
    damaged_tables_of_parquet_are_one_error: "parquet", false;
    damaged_datasets_of_lerobot_v3_are_one_error: "lerobot/v3", true;
    damaged_datasets_of_lerobot_v21_are_one_error: "lerobot/v21", true;
    damaged_texts_that_are_compressed_are_one_error: "compressed", false;
}
