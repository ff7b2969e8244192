//! Any text as a motor file: read or refused, never a panic, and what is accepted is written back the same.
#![no_main]

use servoid_io::input::MotorFile;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match MotorFile::parse(text, "motor.toml") {
        Ok(motor) => {
            let written = motor.to_toml();
            let back = MotorFile::parse(&written, "motor.toml").expect("what we write we read");
            assert_eq!(back, motor);
        }
        Err(error) => assert!(error.to_string().starts_with("motor.toml:")),
    }
});
