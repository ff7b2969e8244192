//! From a run on the bench to the recording that an owner of the motor would have logged.

use crate::channel::{Measured, Series};
use crate::position_loop::{Follower, GainOrigin, LoopSettings};
use crate::recording::{Drive, PositionDrive, Recording};
use servoid_plant::{Amplifier, Bench, BenchError, DriveSample, PositionControl, Run};
use std::f64::consts::TAU;

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
        let mut run = self.run(drive)?;
        let coasts = run.enabled.iter().any(|on| !on);
        let position = match self.amplifier {
            Amplifier::Position(control) => Some(followed(self, control, &mut run)),
            Amplifier::Voltage | Amplifier::Current => None,
        };
        Ok(Recording {
            source: source.to_owned(),
            time_s: run.time_s,
            command: run.voltage_v,
            counts: run.counts.iter().map(|&count| count as f64).collect(),
            measured: Series::NONE.with(Measured::Current, with_current.then_some(run.current_a)),
            enabled: coasts.then_some(run.enabled),
            counts_per_rev: f64::from(self.counts_per_rev),
            quantised: true,
            supply_v: Some(self.machine.supply_v),
            drive: match self.amplifier {
                Amplifier::Voltage | Amplifier::Position(_) => Drive::Voltage,
                Amplifier::Current => Drive::Current,
            },
            position,
        })
    }
}

/// The bench's targets become the volts that an owner who knows the loop would reckon from the log: what the bench's own
/// loop gave is not logged.
fn followed(bench: &Bench, control: PositionControl, run: &mut Run) -> PositionDrive {
    let counts: Vec<f64> = run.counts.iter().map(|&count| count as f64).collect();
    let counts_per_rev = f64::from(bench.counts_per_rev);
    let targets = run.voltage_v.iter();
    let target_counts: Vec<f64> = targets.map(|rad| rad / TAU * counts_per_rev).collect();
    let settings = LoopSettings {
        damping_v_s_per_rad: Some(control.damping_v_s_per_rad),
        dead_band_rad: Some(control.dead_band_rad),
        rate_hz: Some(control.rate_hz),
        ..LoopSettings::default()
    };
    let control = settings.with(control.gain_v_per_rad, control.limit_v, GainOrigin::Given);
    let follower = Follower {
        time_s: &run.time_s,
        target_counts: &target_counts,
        counts: &counts,
        enabled: Some(&run.enabled),
        counts_per_rev,
    };
    run.voltage_v = follower.volts(&control);
    PositionDrive {
        control,
        target_counts,
    }
}
