//! Any bytes as a recording: read or refused, never a panic, and what is accepted keeps its promises.
//! The first byte chooses the units, the rest is the file.
#![no_main]

use libfuzzer_sys::fuzz_target;
use servoid_io::input::{AngleUnit, CommandUnit, MotorFile, Units, read_recording_from};
use servoid_io::output::write_csv;

fuzz_target!(|data: &[u8]| {
    let Some((choice, text)) = data.split_first() else { return };
    let choice = usize::from(*choice);
    let (_, angle) = AngleUnit::ALL[choice % AngleUnit::ALL.len()];
    let (_, voltage) = CommandUnit::ALL[choice / AngleUnit::ALL.len() % CommandUnit::ALL.len()];
    let motor = MotorFile {
        counts_per_rev: Some(2048.0),
        supply_v: Some(24.0),
        metres_per_rev: Some(0.0025),
        units: Units { angle, voltage, ..Units::default() },
        ..MotorFile::default()
    };
    let recording = match read_recording_from(text, "rec.csv", &motor) {
        Ok(recording) => recording,
        Err(error) => {
            assert!(error.to_string().starts_with("rec.csv"));
            return;
        }
    };
    let n = recording.len();
    assert!(n >= 2 && recording.command.len() == n && recording.counts.len() == n);
    assert!(recording.time_s.windows(2).all(|pair| pair[0] < pair[1]));
    let columns = [&recording.time_s, &recording.command, &recording.counts];
    let measured = recording.measured.told().flat_map(|(_, values)| values);
    assert!(columns.into_iter().flatten().chain(measured).all(|x| x.is_finite()));
    let _ = recording.check_excited();
    if recording.quantised {
        let mut bytes = Vec::new();
        write_csv(&mut bytes, &recording, &[]).expect("a vector takes all bytes");
        let contract = MotorFile { counts_per_rev: Some(2048.0), supply_v: Some(24.0), ..MotorFile::default() };
        let back = read_recording_from(&bytes[..], "rec.csv", &contract).expect("what we write we read");
        assert_eq!(back, recording);
    }
});
