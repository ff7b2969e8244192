//! Any bytes as a log of any format: opened or refused, never a panic, and every column that is listed is read or refused, too. One corpus a format;
//! the format is told by the content.
#![no_main]

mod place;

use libfuzzer_sys::fuzz_target;
use servoid_io::input::{MotorFile, read_recordings, survey};

fuzz_target!(|data: &[u8]| {
    place::with_file(data, |path| {
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
