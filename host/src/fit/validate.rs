//! A fitted model on another recording, whose start is its own.

use super::{SPEED_HALF_WIDTH, may_start_moving, scores};
use crate::error::Error;
use crate::problem::cost::{Horizon, errors, rms_counts};
use crate::problem::simulate::Method;
use crate::problem::{Candidate, Data, StartAngle};
use shared::cost::Cost;

/// Step of the start speed by which its effect is measured, as a part of the fastest.
const SPEED_STEP: f64 = 0.01;
/// Errors below this many counts need no better start.
const START_UNNOTICED: f64 = 0.3;
/// Places within the first cell that are tried, counts from its middle.
const START_OFFSETS: [f64; 8] = [-0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4];

/// Error of a fitted model on another recording, whose start angle and speed are its own: RMS in
/// counts over the whole of it.
///
/// # Errors
/// Where the model cannot run.
pub fn validate(data: &Data, candidate: &Candidate, method: Method) -> Result<f64, Error> {
    let errors = validation_errors(data, candidate, method)?;
    Ok(rms_counts(data, &errors))
}

/// Model minus reading on another recording, as in [`validate`]: from the start that the recording agrees with
/// best.
///
/// # Errors
/// Where the model cannot run.
pub fn validation_errors(
    data: &Data,
    candidate: &Candidate,
    method: Method,
) -> Result<Vec<f64>, Error> {
    let run = |start_speed: f64, start_offset: f64| -> Result<Vec<f64>, Error> {
        let candidate = Candidate {
            start_speed,
            start_offset,
            ..*candidate
        };
        let (whole, free) = (Horizon::Whole, StartAngle::Free);
        Ok(errors(
            data,
            &candidate,
            method,
            &whole,
            free,
            Cost::Squared,
        )?)
    };
    let rms = |errors: &[f64]| rms_counts(data, errors);
    // At rest or in motion, whichever the recording agrees with better.
    let (mut best, mut start_speed) = (run(0.0, 0.0)?, 0.0);
    if may_start_moving(data) {
        for speed in moving_starts(data, &|speed| run(speed, 0.0))? {
            let moving = run(speed, 0.0)?;
            if rms(&moving) < rms(&best) {
                (best, start_speed) = (moving, speed);
            }
        }
    }
    if candidate.needs_angle() && data.quantised && rms(&best) >= START_UNNOTICED {
        for offset in START_OFFSETS {
            if let Ok(errors) = run(start_speed, offset)
                && rms(&errors) < rms(&best)
            {
                best = errors;
            }
        }
    }
    if let Some(led) = led(data, candidate, method)
        && rms(&led) < rms(&best)
    {
        best = led;
    }
    Ok(best)
}

/// Model minus reading at the end of a whole recording, for a model that ran along it from its begin.
fn led(data: &Data, candidate: &Candidate, method: Method) -> Option<Vec<f64>> {
    let whole = data.end_of.as_ref()?;
    let mut errors = scores::whole(whole, candidate, method).ok()?;
    let before = errors.len().checked_sub(data.len())?;
    Some(errors.split_off(before))
}

/// Speeds at the first sample, rad/s: a few readings tell it roughly; the whole recording tells it by least
/// squares, since errors are nearly linear in it.
fn moving_starts(
    data: &Data,
    run: &dyn Fn(f64) -> Result<Vec<f64>, Error>,
) -> Result<Vec<f64>, Error> {
    let now = data.speed_counts_s(0, SPEED_HALF_WIDTH) / data.units.counts_per_rev
        * core::f64::consts::TAU;
    let step = SPEED_STEP * data.units.speed;
    let (here, ahead) = (run(now)?, run(now + step)?);
    let centre = data.centre(0) - data.counts[0];
    let (mut pull, mut square) = (0.0, 0.0);
    for (here, ahead) in here.iter().zip(&ahead) {
        let slope = ahead - here;
        pull -= slope * (here - centre);
        square += slope * slope;
    }
    let better = now + step * pull / square;
    Ok(if better.is_finite() {
        vec![now, better]
    } else {
        vec![now]
    })
}
