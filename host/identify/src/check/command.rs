//! The command against the supply.

use super::{Finding, Severity};
use servoid_io::recording::{Drive, Recording};

/// Commands may exceed the stated supply by this part.
const ABOVE_SUPPLY: f64 = 0.02;
/// Commands of so many times the supply are in another unit.
const OTHER_UNIT: f64 = 50.0;
/// A top is flat where the same largest command stands for so many samples, and it is cut off if it is reached
/// smoothly: from within this part of it.
const FLAT: (usize, f64) = (3, 0.2);
/// Most levels of a command that is stepped on purpose.
const LEVELS: usize = 16;
/// Cut-off tops that cannot be chance.
const TOPS: usize = 4;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    if recording.position.is_some() {
        // A loop that stands at its limit is in the model.
        return Vec::new();
    }
    let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    above_supply(recording, largest)
        .into_iter()
        .chain(cut_off(recording, largest))
        .collect()
}

fn above_supply(recording: &Recording, largest: f64) -> Option<Finding> {
    let supply = (recording.supply_v).filter(|_| recording.drive == Drive::Voltage)?;
    if largest <= supply * (1.0 + ABOVE_SUPPLY) {
        return None;
    }
    let seen = format!("commands reach {largest:.2} V and supply_v is {supply:.2} V");
    let percent = (99.0..=101.0).contains(&largest);
    Some(if largest > supply * OTHER_UNIT {
        Finding::new(
            "command_unit",
            Severity::Refusal,
            format!("commands reach {largest:.3e} V and supply_v is {supply:.2} V"),
            "that is another unit (mV?) or another motor's file; scale the column to V, or correct supply_v",
        )
    } else if percent {
        Finding::new(
            "command_unit",
            Severity::Warning,
            seen,
            "that looks like a duty in percent taken for volts; scale the column to V",
        )
    } else {
        Finding::new(
            "command_above_supply",
            Severity::Warning,
            seen,
            "the bridge clips them; log what it can give, or correct supply_v",
        )
    })
}

fn cut_off(recording: &Recording, largest: f64) -> Option<Finding> {
    let tops = cut_tops(recording, largest);
    let unit = recording.drive.symbol();
    (tops >= TOPS && !few_levels(recording)).then(|| {
        Finding::new(
            "command_cut_off",
            Severity::Warning,
            format!("the command is cut off at {largest:.2} {unit}, {tops} times"),
            "if the motor saw more than the log says, the model is fed wrong; log the command behind its limits and before \
             the log's own",
        )
    })
}

/// Whether the command is made of a few levels, as a telegraph is: its largest is no limit.
fn few_levels(recording: &Recording) -> bool {
    let mut levels: Vec<f64> = Vec::new();
    for &command in &recording.command {
        if !levels.contains(&command) {
            levels.push(command);
        }
        if levels.len() > LEVELS {
            return false;
        }
    }
    true
}

/// How many times the command runs smoothly into its largest value and stays there.
fn cut_tops(recording: &Recording, largest: f64) -> usize {
    let command = &recording.command;
    let (flat, near) = FLAT;
    (1..command.len().saturating_sub(flat))
        .filter(|&k| {
            let top = command[k].abs() == largest;
            let before = command[k - 1];
            let smooth = before != command[k] && (before - command[k]).abs() < near * largest;
            top && smooth && command[k..k + flat].iter().all(|v| *v == command[k])
        })
        .count()
}
