//! Readings that repeat, and readings that are no whole counts.

use super::{Finding, Severity};
use servoid_io::recording::Recording;

/// A motor that moves on by so many counts a sample changes its reading at every one of them.
const MOVING: f64 = 3.0;
/// Samples to each side over which that is seen.
const AROUND: usize = 12;
/// Part of the samples in motion whose reading repeats the one before, from which on the sensor is slower than the log.
const REPEATED: f64 = 0.3;
/// Fewest samples in motion that say so.
const FEWEST: usize = 100;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Some((part, every)) = repeated(recording) {
        findings.push(Finding::new(
            "held_readings",
            Severity::Warning,
            format!(
                "{:.0} % of the readings in motion repeat the one before: the sensor gives a new value every {:.4} s, the log \
                 a row every {:.4} s",
                100.0 * part,
                every,
                recording.median_interval_s()
            ),
            "the angle is late by up to that time; log rows only when the reading is new, or thin the file to them",
        ));
    }
    if !recording.quantised {
        findings.push(Finding::new(
            "off_lattice",
            Severity::Remark,
            format!(
                "the angle is not in whole counts of {} a revolution",
                recording.counts_per_rev
            ),
            "it was filtered or converted, or counts_per_rev is another; errors have no floor then that a model could reach",
        ));
    }
    findings
}

/// The part of the readings in motion that repeat the one before, and the time between new ones, s.
fn repeated(recording: &Recording) -> Option<(f64, f64)> {
    let counts = &recording.counts;
    let (mut moving, mut same, mut time) = (0usize, 0usize, 0.0);
    for k in AROUND..counts.len().saturating_sub(AROUND) {
        let travel = (counts[k + AROUND] - counts[k - AROUND]).abs();
        if travel < MOVING * 2.0 * AROUND as f64 {
            continue;
        }
        moving += 1;
        time += recording.time_s[k] - recording.time_s[k - 1];
        same += usize::from(counts[k] == counts[k - 1]);
    }
    let part = same as f64 / moving.max(1) as f64;
    (moving >= FEWEST && part > REPEATED).then(|| (part, time / (moving - same).max(1) as f64))
}
