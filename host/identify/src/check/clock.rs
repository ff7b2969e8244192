//! The sample times.

use super::{Finding, Severity};
use servoid_io::recording::Recording;

/// Shorter than this a recording says little, s.
const SHORT_S: f64 = 1.0;
/// Samples so far apart are of hardly any log in seconds, s.
const MUST_BE_MS: f64 = 0.5;
/// An interval of so many usual ones is a gap.
const GAP: f64 = 5.0;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    let interval = recording.median_interval_s();
    let length = recording.duration_s();
    let mut findings = Vec::new();
    if interval >= MUST_BE_MS {
        findings.push(Finding::new(
            "slow_clock",
            Severity::Warning,
            format!("samples are {interval:.3} s apart"),
            "if that is time in milliseconds, say --unit time=ms (or us); no motor's time constants show in samples of a second",
        ));
    }
    if length < SHORT_S {
        findings.push(Finding::new(
            "short",
            Severity::Remark,
            format!("lasts {length:.3} s, less than a second"),
            "what acts slowly or seldom cannot show in it",
        ));
    }
    let steps = recording.time_s.windows(2).map(|pair| pair[1] - pair[0]);
    let gaps: Vec<f64> = steps.filter(|step| *step > GAP * interval).collect();
    if !gaps.is_empty() {
        let longest = gaps.iter().fold(0.0f64, |m, gap| m.max(*gap));
        let times = if gaps.len() == 1 { "gap" } else { "gaps" };
        findings.push(Finding::new(
            "gaps",
            Severity::Remark,
            format!(
                "the log has {} {times}, the longest of {longest:.3} s, where samples are {interval:.6} s apart",
                gaps.len()
            ),
            "the command is taken to hold through a gap; if these are several runs in one file, split it",
        ));
    }
    findings
}
