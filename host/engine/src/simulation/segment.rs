//! The segments of a recording that a model runs through, each from a start of its own.

use super::candidate::Candidate;
use super::horizon::{Horizon, StartAngle, Window};
use crate::data::Data;
use std::ops::Range;

/// Consecutive samples that a model runs through from a start of their own.
#[derive(Clone, Debug)]
pub struct Segment {
    /// Its samples.
    pub range: Range<usize>,
    /// Encoder angle at the first sample, counts.
    pub angle: f64,
    /// Speed at the first sample, rad/s.
    pub speed: f64,
}

/// The first recording as one segment, with the candidate's start.
pub fn whole(data: &Data, candidate: &Candidate, start_angle: StartAngle) -> Segment {
    let angle = match start_angle {
        StartAngle::Known => data.counts[0],
        StartAngle::Free => data.centre(0) + candidate.start_offset,
    };
    Segment {
        range: data.recordings.holding(0),
        angle,
        speed: candidate.start_speed,
    }
}

/// The recordings after the first: each from its own measured start.
fn further(data: &Data, start_angle: StartAngle) -> impl Iterator<Item = Segment> {
    data.recordings.ranges().skip(1).map(move |range| {
        let first = range.start;
        Segment {
            angle: match start_angle {
                StartAngle::Known => data.counts[first],
                StartAngle::Free => data.centre(first),
            },
            speed: data.start_speed(first),
            range,
        }
    })
}

/// The segments of a horizon, with the candidate's start.
pub fn segments(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
) -> Vec<Segment> {
    match horizon {
        Horizon::Whole => std::iter::once(whole(data, candidate, start_angle))
            .chain(further(data, start_angle))
            .collect(),
        Horizon::Observer(_) | Horizon::Corrected(_) => std::iter::once(Segment {
            angle: data.centre(0),
            ..whole(data, candidate, start_angle)
        })
        .chain(further(data, StartAngle::Free))
        .collect(),
        Horizon::Windows(windows) => {
            let segment = |window: &Window| Segment {
                range: window.range.clone(),
                angle: window.angle,
                speed: window.speed,
            };
            windows.iter().map(segment).collect()
        }
    }
}
