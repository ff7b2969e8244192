//! What the motion reaches: a model learns nothing of what a recording does not show.

use super::{Finding, Severity};
use servoid_io::recording::Recording;

/// Part of the travel against the prevailing direction below which a motor never reverses.
const REVERSES: f64 = 0.05;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    let (mut forward, mut backward) = (0.0, 0.0);
    for pair in recording.counts.windows(2) {
        let step = pair[1] - pair[0];
        if step > 0.0 {
            forward += step;
        } else {
            backward -= step;
        }
    }
    let travel = forward + backward;
    if travel == 0.0 || forward.min(backward) > REVERSES * travel {
        return Vec::new();
    }
    vec![Finding::new(
        "one_way",
        Severity::Remark,
        "the motor never reverses",
        "friction, an offset and a load look alike then; record steps of both signs, or a slow triangle through zero",
    )]
}
