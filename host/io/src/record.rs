//! From a run on the bench to the recording that an owner of the motor would have logged.

use crate::recording::{Drive, Recording};
use servoid_plant::{Amplifier, Bench, BenchError, DriveSample};

/// A bench whose runs are recorded.
pub trait Record {
    /// Plays the drive and keeps what can be measured: time, command, counts; the bridge's state where
    /// it was ever open, and the current with `with_current`.
    ///
    /// # Errors
    /// As [`Bench::run`].
    fn record(
        &self,
        drive: &[DriveSample],
        source: &str,
        with_current: bool,
    ) -> Result<Recording, BenchError>;
}

impl Record for Bench {
    fn record(
        &self,
        drive: &[DriveSample],
        source: &str,
        with_current: bool,
    ) -> Result<Recording, BenchError> {
        let run = self.run(drive)?;
        let coasts = run.enabled.iter().any(|on| !on);
        Ok(Recording {
            source: source.to_owned(),
            time_s: run.time_s,
            command: run.voltage_v,
            counts: run.counts.iter().map(|&count| count as f64).collect(),
            current_a: with_current.then_some(run.current_a),
            enabled: coasts.then_some(run.enabled),
            counts_per_rev: f64::from(self.counts_per_rev),
            quantised: true,
            supply_v: Some(self.machine.supply_v),
            drive: match self.amplifier {
                Amplifier::Voltage => Drive::Voltage,
                Amplifier::Current => Drive::Current,
            },
        })
    }
}
