//! The error of a fitted model on another recording, which has a start of its own.

use super::scores;
use super::start::SPEED_HALF_WIDTH;
use crate::error::Error;
use servoid_engine::problem::{Candidate, Data, StartAngle};
use servoid_engine::problem::{Horizon, errors, rms_counts};
use servoid_engine::simulation::Method;
use shared::cost::Cost;

/// Step of the start speed for its difference quotient, relative to the fastest speed.
const SPEED_STEP: f64 = 0.01;
/// RMS error below which no better start is searched for, counts.
const START_UNNOTICED: f64 = 0.3;
/// Start angles within the first encoder cell that are tried, counts from its middle.
pub const START_OFFSETS: [f64; 8] = [-0.4, -0.3, -0.2, -0.1, 0.1, 0.2, 0.3, 0.4];

/// Error at which a run has departed from the readings, counts: slopes say nothing about what follows.
const DEPARTED_COUNTS: f64 = 4.0;
/// Least part of the recording that a run must follow: then its departure may depend on where in the cell it started.
const LEAST_FOLLOWED: f64 = 0.05;
/// First step of the start offset for its difference quotient, counts.
const OFFSET_STEP: f64 = 1e-5;
/// Wanted RMS change of the errors by that step, counts: far along a chaotic run a larger one slips a detent.
const NOTICED: f64 = 0.01;
/// Steps without progress after which the refinement ends.
const STALLED: usize = 3;

/// The first sample at which a run has departed from the readings; their number if it has not.
pub fn departure(data: &Data, errors: &[f64]) -> usize {
    let centre = data.half_cell();
    errors
        .iter()
        .position(|error| (error - centre).abs() > DEPARTED_COUNTS)
        .unwrap_or(errors.len())
}

/// Error of a fitted model on another recording, whose start angle and speed are its own: RMS in
/// counts over the whole of it.
///
/// # Errors
/// Where the model cannot run.
pub fn validate(data: &Data, candidate: &Candidate, method: Method) -> Result<f64, Error> {
    let errors = validation_errors(data, candidate, method)?;
    Ok(rms_counts(data, &errors))
}

/// As [`validate`], for one of many models: faster, without the refined start, so larger where the run is chaotic.
///
/// # Errors
/// Where the model cannot run.
pub fn validate_roughly(data: &Data, candidate: &Candidate, method: Method) -> Result<f64, Error> {
    let errors = errors_from(data, candidate, method, Start::Grid)?;
    Ok(rms_counts(data, &errors))
}

/// Model minus reading on another recording, counts, one entry a sample, as in [`validate`]: from the start with the
/// least error.
///
/// # Errors
/// Where the model cannot run.
pub fn validation_errors(
    data: &Data,
    candidate: &Candidate,
    method: Method,
) -> Result<Vec<f64>, Error> {
    errors_from(data, candidate, method, Start::Refined)
}

/// How the start angle within the first cell is found.
#[derive(Clone, Copy, PartialEq)]
enum Start {
    /// From a grid.
    Grid,
    /// From the grid's angle that follows the readings furthest, refined by least squares.
    Refined,
}

/// Each recording has a start of its own.
fn errors_from(
    data: &Data,
    candidate: &Candidate,
    method: Method,
    start: Start,
) -> Result<Vec<f64>, Error> {
    if !data.recordings.are_several() {
        return errors_of_one(data, candidate, method, start);
    }
    let errors = data
        .parts()
        .map(|part| errors_of_one(&part, candidate, method, start));
    Ok(errors.collect::<Result<Vec<_>, _>>()?.concat())
}

fn errors_of_one(
    data: &Data,
    candidate: &Candidate,
    method: Method,
    start: Start,
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
    // At rest or in motion, whichever has the smaller error.
    let (mut best, mut start_speed) = (run(0.0, 0.0)?, 0.0);
    if data.may_start_moving(0) {
        for speed in moving_starts(data, &|speed| run(speed, 0.0))? {
            let moving = run(speed, 0.0)?;
            if rms(&moving) < rms(&best) {
                (best, start_speed) = (moving, speed);
            }
        }
    }
    if candidate.needs_angle() && data.quantised && rms(&best) >= START_UNNOTICED {
        let mut longest = (departure(data, &best), 0.0);
        for offset in START_OFFSETS {
            if let Ok(errors) = run(start_speed, offset) {
                let to = departure(data, &errors);
                if to > longest.0 {
                    longest = (to, offset);
                }
                if rms(&errors) < rms(&best) {
                    best = errors;
                }
            }
        }
        if start == Start::Refined
            && rms(&best) >= START_UNNOTICED
            && let Some(refined) =
                refined_offset(data, longest.1, &|offset| run(start_speed, offset))?
            && rms(&refined) < rms(&best)
        {
            best = refined;
        }
    }
    if let Some(continued) = continued_from_whole(data, candidate, method)
        && rms(&continued) < rms(&best)
    {
        best = continued;
    }
    Ok(best)
}

/// Errors from a refined start angle: Gauss-Newton over the stretch that the run already follows, which extends the
/// stretch. `None` where no run follows the readings for long.
fn refined_offset(
    data: &Data,
    mut offset: f64,
    run: &dyn Fn(f64) -> Result<Vec<f64>, Error>,
) -> Result<Option<Vec<f64>>, Error> {
    let centre = data.half_cell();
    let length = |errors: &[f64]| errors.iter().map(|e| (e - centre).powi(2)).sum::<f64>();
    let (mut reached, mut stalled) = (0, 0);
    let mut step = OFFSET_STEP;
    let mut best: Option<Vec<f64>> = None;
    while stalled < STALLED {
        let errors = run(offset)?;
        let to = departure(data, &errors);
        if to < reached || (to as f64) < LEAST_FOLLOWED * data.len() as f64 {
            break;
        }
        stalled = if to > reached { 0 } else { stalled + 1 };
        reached = to;
        let ahead = run(offset + step)?;
        let change: f64 = errors[..to]
            .iter()
            .zip(&ahead[..to])
            .map(|(e, a)| (a - e).powi(2))
            .sum();
        offset += slope_step(&errors[..to], &ahead[..to], step, centre);
        // The next stretch is more sensitive.
        step = (step * NOTICED / (change / to as f64).sqrt()).clamp(1e-10, OFFSET_STEP);
        if best
            .as_ref()
            .is_none_or(|best| length(&errors) < length(best))
        {
            best = Some(errors);
        }
    }
    Ok(best)
}

/// Gauss-Newton step of one parameter for errors about `centre`, from the errors `here` and `ahead` by `step`; zero where it
/// is not finite.
fn slope_step(here: &[f64], ahead: &[f64], step: f64, centre: f64) -> f64 {
    let (mut pull, mut square) = (0.0, 0.0);
    for (here, ahead) in here.iter().zip(ahead) {
        let slope = ahead - here;
        pull -= slope * (here - centre);
        square += slope * slope;
    }
    let better = step * pull / square;
    if better.is_finite() { better } else { 0.0 }
}

/// Model minus reading at the end of a whole recording, for a model that ran along it from its begin.
fn continued_from_whole(data: &Data, candidate: &Candidate, method: Method) -> Option<Vec<f64>> {
    let whole = data.end_of.as_ref()?;
    let mut errors = scores::whole(whole, candidate, method).ok()?;
    let before = errors.len().checked_sub(data.len())?;
    Some(errors.split_off(before))
}

/// Speeds at the first sample, rad/s: one from a few readings, and one by a Gauss-Newton step over the whole recording.
fn moving_starts(
    data: &Data,
    run: &dyn Fn(f64) -> Result<Vec<f64>, Error>,
) -> Result<Vec<f64>, Error> {
    let now = data.speed_counts_s(0, SPEED_HALF_WIDTH) / data.units.counts_per_rev
        * core::f64::consts::TAU;
    let step = SPEED_STEP * data.units.speed;
    let (here, ahead) = (run(now)?, run(now + step)?);
    let centre = data.half_cell();
    let better = now + slope_step(&here, &ahead, step, centre);
    Ok(vec![now, better])
}
