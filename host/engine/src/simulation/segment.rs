//! The parts of a recording that a model runs through on its own.

use super::candidate::Candidate;
use super::horizon::{Horizon, StartAngle, Window};
use crate::data::Data;
use std::ops::Range;

/// A part of the recording that a model runs through on its own.
#[derive(Clone, Debug)]
pub struct Leg {
    /// Its samples.
    pub range: Range<usize>,
    /// What the encoder sees at its first one, counts.
    pub angle: f64,
    /// Speed there, rad/s.
    pub speed: f64,
}

/// The whole of the data for a candidate.
pub fn whole(data: &Data, candidate: &Candidate, start_angle: StartAngle) -> Leg {
    let angle = match start_angle {
        StartAngle::Known => data.counts[0],
        StartAngle::Free => data.centre(0) + candidate.start_offset,
    };
    Leg {
        range: 0..data.len(),
        angle,
        speed: candidate.start_speed,
    }
}

/// The legs of a horizon for a candidate.
pub fn legs(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
) -> Vec<Leg> {
    match horizon {
        Horizon::Whole => vec![whole(data, candidate, start_angle)],
        Horizon::Nudged(_) => vec![Leg {
            angle: data.centre(0),
            ..whole(data, candidate, start_angle)
        }],
        Horizon::Windows(windows) => {
            let leg = |window: &Window| Leg {
                range: window.range.clone(),
                angle: data.centre(window.range.start),
                speed: window.speed,
            };
            windows.iter().map(leg).collect()
        }
    }
}
