//! A motor that stands at the beginning or the end of a log under commands that move it elsewhere: its bridge was off.

use crate::median::median;
use crate::recording::Recording;
use std::ops::Range;

/// Time under strong commands in which a motor that is driven has moved, s.
const DRIVEN_S: f64 = 0.5;
/// Commands above this part of the largest one must move a free motor.
const STRONG: f64 = 0.5;

/// The samples in which the bridge drives, and what keeps others out; `None` where none is to be left out, and where the log itself says
/// when the bridge drives: a servo that holds a weight stands under strong commands, too.
pub(super) fn driven(recording: &Recording) -> Option<Range<usize>> {
    if recording.position.is_some() || recording.enabled.is_some() {
        return None;
    }
    let counts = &recording.counts;
    let first = counts.windows(2).position(|pair| pair[1] != pair[0])?;
    let last = counts.windows(2).rposition(|pair| pair[1] != pair[0])? + 1;
    let moving: Vec<f64> = (first..last)
        .filter(|k| counts[*k] != counts[k + 1])
        .map(|k| recording.command[k].abs())
        .collect();
    let usual = median(moving)?;
    let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let strong = usual.max(STRONG * largest);
    let time = &recording.time_s;
    let driven_s = |range: Range<usize>| -> f64 {
        let strong = range.filter(|k| recording.command[*k].abs() >= strong);
        strong.map(|k| time[k + 1] - time[k]).sum()
    };
    // The last command acts until the first motion shows; some of it is left for that.
    let from = if driven_s(0..first) > DRIVEN_S {
        first
    } else {
        0
    };
    let to = if driven_s(last..recording.len() - 1) > DRIVEN_S && !is_abrupt(counts, last) {
        coasting_from(counts, last)
    } else {
        recording.len()
    };
    ((from, to) != (0, recording.len()) && to >= from + 2).then_some(from..to)
}

/// Readings over which a speed is taken while a motor coasts.
const BLOCK: usize = 10;
/// So few counts in a block tell no change of the speed.
const FEW_COUNTS: f64 = 2.0;

/// Where a motor that is at rest from a sample on began to coast: before it slowed down all the way. If the command braked it at first,
/// this is earlier than the bridge opened, which does no harm.
fn coasting_from(counts: &[f64], rest: usize) -> usize {
    let (mut fastest, mut from) = (0.0, rest + 1);
    let mut end = rest;
    while let Some(begin) = end.checked_sub(BLOCK) {
        let speed = (counts[end] - counts[begin]).abs();
        if speed <= fastest && fastest > FEW_COUNTS {
            break;
        }
        (fastest, from, end) = (speed, begin, begin);
    }
    from
}

/// The last step of a motor that coasts to rest is smaller than this part of its steps before.
const ABRUPT: f64 = 0.5;

/// Whether a reading stops at full speed, as only one that is stuck does.
fn is_abrupt(counts: &[f64], rest: usize) -> bool {
    let (Some(before), Some(begin)) = (rest.checked_sub(1), rest.checked_sub(BLOCK + 1)) else {
        return true;
    };
    let usual = (counts[before] - counts[begin]).abs() / BLOCK as f64;
    (counts[rest] - counts[before]).abs() > (ABRUPT * usual).max(FEW_COUNTS)
}
