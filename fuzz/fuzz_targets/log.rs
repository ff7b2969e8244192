//! Any bytes as a log of any format: opened or refused, never a panic, and every column that is listed is read or refused, too. One corpus a format;
//! the format is told by the content.
#![no_main]

use libfuzzer_sys::fuzz_target;
use servoid_io::input::{MotorFile, read_recordings, survey};
use std::cell::RefCell;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::PathBuf;

thread_local! {
    /// A file in memory, where the system has a place for such.
    static PLACE: RefCell<(PathBuf, File)> = RefCell::new(place());
}

fn place() -> (PathBuf, File) {
    let memory = PathBuf::from("/dev/shm");
    let folder = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let path = folder.join(format!("servoid-fuzz-{}", std::process::id()));
    let file = File::create(&path).expect("a file");
    (path, file)
}

fuzz_target!(|data: &[u8]| {
    PLACE.with_borrow_mut(|(path, file)| {
        file.set_len(0).expect("emptied");
        file.seek(SeekFrom::Start(0)).expect("begun");
        file.write_all(data).expect("written");
        let motor = MotorFile {
            counts_per_rev: Some(2048.0),
            supply_v: Some(24.0),
            ..MotorFile::default()
        };
        if let Ok(found) = survey(path, &motor, Some(1000), &|_| ()) {
            // What is proposed is read, or refused in words.
            let mut proposed = found.proposal.motor.clone();
            proposed.counts_per_rev.get_or_insert(2048.0);
            let _ = found.proposal.options();
            if let Ok(reading) = read_recordings(path, &proposed) {
                for recording in &reading.recordings {
                    let n = recording.len();
                    assert!(n >= 2 && recording.command.len() == n && recording.counts.len() == n);
                    assert!(recording.time_s.windows(2).all(|pair| pair[0] < pair[1]));
                    let columns = [&recording.time_s, &recording.command, &recording.counts];
                    assert!(columns.into_iter().flatten().all(|x| x.is_finite()));
                    let _ = recording.check_excited();
                }
            }
        }
    });
});
