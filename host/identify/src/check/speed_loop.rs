//! A command that is the setpoint of a speed loop: where it stands for a while the motor turns at just that speed, in a unit that people use.

use super::{Finding, Severity};
use servoid_io::recording::Recording;
use std::f64::consts::TAU;

/// Units of a setpoint: rad/s of one of it.
const UNITS: [(&str, f64); 4] = [
    ("rad/s", 1.0),
    ("deg/s", TAU / 360.0),
    ("rpm", TAU / 60.0),
    ("rev/s", TAU),
];
/// A setpoint that stands so long is reached, s; and of that time the end is looked at.
const STANDS_S: f64 = 0.25;
const END: f64 = 0.4;
/// Speed and setpoint agree to this part.
const AGREE: f64 = 0.02;
/// Different setpoints that must agree: one may be chance.
const FEWEST: usize = 4;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    if recording.position.is_some() || !recording.drive.is_voltage() {
        return Vec::new();
    }
    let reached = steady(recording);
    let mut levels: Vec<f64> = reached.iter().map(|pair| pair.0).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    if levels.len() < FEWEST {
        return Vec::new();
    }
    let named = UNITS.iter().find(|(_, unit)| {
        let agree =
            |pair: &&(f64, f64)| (pair.1 - pair.0 * unit).abs() <= AGREE * (pair.0 * unit).abs();
        let agreeing = reached.iter().filter(agree).count();
        agreeing * 10 >= reached.len() * 9
    });
    let finding = named.map(|(unit, _)| {
        Finding::new(
            "speed_loop",
            Severity::Warning,
            format!(
                "the command is a speed setpoint in {unit}, and no voltage: where it stands, the motor turns at just that speed ({} times)",
                reached.len()
            ),
            "a speed loop hides the motor; log the voltage (or the current) that its controller gives, and name that column",
        )
    });
    finding.into_iter().collect()
}

/// Commands that stand for a while, each with the speed at their end, rad/s.
fn steady(recording: &Recording) -> Vec<(f64, f64)> {
    let (time, command) = (&recording.time_s, &recording.command);
    let mut found = Vec::new();
    let mut begin = 0;
    for k in 1..=command.len() {
        if k < command.len() && command[k] == command[begin] {
            continue;
        }
        let end = k - 1;
        let seconds = time[end] - time[begin];
        if seconds >= STANDS_S && command[begin] != 0.0 {
            let from = time[begin..end].partition_point(|t| *t < time[end] - END * seconds) + begin;
            let counts = recording.counts[end] - recording.counts[from];
            let speed = counts / recording.counts_per_rev * TAU / (time[end] - time[from]);
            if speed.is_finite() {
                found.push((command[begin], speed));
            }
        }
        begin = k;
    }
    found
}
