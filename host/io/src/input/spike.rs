//! A reading that stands alone: the encoder jumps and is back at the next sample, which no shaft does.

use super::read_error::ReadFault;
use crate::recording::Recording;

/// A jump is beyond what the shaft does from so many times its usual largest step on, and from so many counts.
const BEYOND: (f64, f64) = (10.0, 20.0);
/// Largest steps that may be a fault's own: at least so many, and one in so many.
const NOT_USUAL: (usize, usize) = (6, 100);

/// The first reading that stands alone.
pub(super) fn spike(recording: &Recording) -> Option<ReadFault> {
    let counts = &recording.counts;
    let mut steps: Vec<f64> = counts.windows(2).map(|p| (p[1] - p[0]).abs()).collect();
    let apart = NOT_USUAL.0.max(steps.len() / NOT_USUAL.1);
    if steps.len() <= 2 * apart {
        return None;
    }
    let usual = *steps.select_nth_unstable_by(apart, |a, b| b.total_cmp(a)).1;
    let beyond = (BEYOND.0 * usual).max(BEYOND.1);
    let alone = |three: &[f64]| {
        let (there, back) = (three[1] - three[0], three[2] - three[1]);
        there * back < 0.0
            && there.abs().min(back.abs()) > beyond
            && (there + back).abs() < 0.5 * beyond
    };
    let before = counts.windows(3).position(alone)?;
    let (from, at, to) = (counts[before], counts[before + 1], counts[before + 2]);
    Some(ReadFault::Spike {
        time_s: recording.time_s[before + 1],
        sample: before + 2,
        from,
        at,
        to,
        off: at - (from + to) / 2.0,
    })
}
