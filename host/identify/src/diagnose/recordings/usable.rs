//! What can be wrong with one recording before anything is fitted to it.

use super::remark::Remark;
use crate::error::Error;
use servoid_io::recording::{Drive, Recording};

/// Shorter than this a recording says little, s.
const SHORT_S: f64 = 1.0;
/// Samples so far apart may be of a log in milliseconds, and so far apart they are of hardly any other, s.
const MAY_BE_MS: f64 = 0.1;
const MUST_BE_MS: f64 = 0.5;
/// An encoder that reads the same for so long is stuck, if the motor is driven meanwhile, s.
const STUCK_S: f64 = 0.2;
/// Time without a change of sign under such a drive that must move a motor, s.
const DRIVEN_S: f64 = 0.05;
/// Commands above this part of the largest one must move the motor.
const STRONG: f64 = 0.5;
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

/// Remarks on a recording.
///
/// # Errors
/// [`Error::Failed`] where its encoder was stuck, or its commands are in another unit.
pub fn check(recording: &Recording) -> Result<Vec<Remark>, Error> {
    let mut remarks = Vec::new();
    let interval = recording.median_interval_s();
    if let Some((from, to, volts)) = stuck(recording) {
        if interval >= MAY_BE_MS {
            return Err(Error::Failed(format!(
                "{}: samples are {interval:.3} s apart, {:.0} s in all: time looks like milliseconds taken for seconds; \
                 say --unit time=ms (or us), or time = \"ms\" under [units] in motor.toml",
                recording.source,
                recording.duration_s()
            )));
        }
        return Err(Error::Failed(format!(
            "{}: the encoder is stuck from {from:.3} to {to:.3} s: it reads the same count while {volts:.2} {} \
             and more are commanded, which moves the motor elsewhere; check the encoder and that the shaft was free, and cut \
             that part out",
            recording.source,
            unit(recording)
        )));
    }
    if interval >= MUST_BE_MS {
        remarks.push(Remark::cause(format!(
            "{}: samples are {interval:.3} s apart: if that is time in milliseconds, say --unit time=ms (or us); no motor's \
             time constants show in samples of a second",
            recording.source
        )));
    }
    if recording.duration_s() < SHORT_S {
        remarks.push(Remark::aside(format!(
            "{}: lasts {:.3} s, less than a second: what acts slowly or seldom cannot show in it",
            recording.source,
            recording.duration_s()
        )));
    }
    let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    if let Some(supply) = recording
        .supply_v
        .filter(|_| recording.drive == Drive::Voltage)
        && largest > supply * (1.0 + ABOVE_SUPPLY)
    {
        if largest > supply * OTHER_UNIT {
            return Err(Error::Failed(format!(
                "{}: commands reach {largest:.3e} V and supply_v is {supply:.2} V: that is another unit (mV?) or another \
                 motor's file; scale the column to V, or correct supply_v",
                recording.source
            )));
        }
        remarks.push(Remark::cause(format!(
            "{}: commands reach {largest:.2} V and supply_v is {supply:.2} V: the bridge clips them; log what it can \
             give, or correct supply_v",
            recording.source
        )));
    }
    let tops = cut_tops(recording, largest);
    if tops >= TOPS && !few_levels(recording) {
        remarks.push(Remark::cause(format!(
            "{}: the command is cut off at {largest:.2} {}, {tops} times: if the motor saw more than the log says, the \
             model is fed wrong; log the command behind its limits and before the log's own",
            recording.source,
            unit(recording)
        )));
    }
    Ok(remarks)
}

fn unit(recording: &Recording) -> &'static str {
    match recording.drive {
        Drive::Voltage => "V",
        Drive::Current => "A",
    }
}

/// A stretch in which the reading never changes under commands as strong as those that usually move the motor:
/// its begin and end, s after the first sample, and the least command in it.
fn stuck(recording: &Recording) -> Option<(f64, f64, f64)> {
    let closed = |k: usize| recording.enabled.as_ref().is_none_or(|on| on[k]);
    let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let mut moving: Vec<f64> = (1..recording.len())
        .filter(|&k| recording.counts[k] != recording.counts[k - 1])
        .map(|k| recording.command[k - 1].abs())
        .collect();
    if moving.is_empty() {
        return None;
    }
    let middle = moving.len() / 2;
    let usual = *moving.select_nth_unstable_by(middle, f64::total_cmp).1;
    let strong = usual.max(STRONG * largest);
    let mut begin = 0;
    for k in 1..=recording.len() {
        if k < recording.len() && recording.counts[k] == recording.counts[begin] {
            continue;
        }
        let still = begin..k;
        let seconds = recording.time_s[k - 1] - recording.time_s[begin];
        begin = k;
        if seconds < STUCK_S {
            continue;
        }
        let driven = |&k: &usize| closed(k) && recording.command[k].abs() >= strong;
        let driven_s = longest_s(recording, still.clone().filter(driven));
        if driven_s >= DRIVEN_S {
            let at = |k: usize| recording.time_s[k] - recording.time_s[0];
            return Some((at(still.start), at(k - 1), strong));
        }
    }
    None
}

/// The longest time for which the command keeps its sign over neighbouring ones of these samples, s.
fn longest_s(recording: &Recording, samples: impl Iterator<Item = usize>) -> f64 {
    let sign = |k: usize| recording.command[k].signum();
    let mut longest = 0.0f64;
    let mut run: Option<(usize, usize)> = None;
    for k in samples {
        let on = run.filter(|&(_, last)| last + 1 == k && sign(last) == sign(k));
        let from = on.map_or(k, |(from, _)| from);
        longest = longest.max(recording.time_s[k] - recording.time_s[from]);
        run = Some((from, k));
    }
    longest
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
