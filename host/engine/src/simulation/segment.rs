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

/// The whole recording as one segment.
pub fn whole(data: &Data, candidate: &Candidate, start_angle: StartAngle) -> Segment {
    let angle = match start_angle {
        StartAngle::Known => data.counts[0],
        StartAngle::Free => data.centre(0) + candidate.start_offset,
    };
    Segment {
        range: 0..data.len(),
        angle,
        speed: candidate.start_speed,
    }
}

/// The segments of a horizon, with the candidate's start.
pub fn segments(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
) -> Vec<Segment> {
    match horizon {
        Horizon::Whole => vec![whole(data, candidate, start_angle)],
        Horizon::Observer(_) => vec![Segment {
            angle: data.centre(0),
            ..whole(data, candidate, start_angle)
        }],
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
