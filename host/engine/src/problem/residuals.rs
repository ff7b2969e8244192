//! Residuals: model minus reading over a horizon, and their root mean square.

use crate::data::Data;
use crate::simulation::{Candidate, Horizon, Method, Simulation, StartAngle, segments};
use shared::cost::Cost;
use shared::error::ModelError;

/// Offset that is added to an error before the cost, counts: costs expect the distance above a floored reading, and an
/// analogue reading is the angle itself.
pub(crate) fn reading_shift(data: &Data) -> f64 {
    if data.quantised {
        0.0
    } else {
        shared::encoder::FLOOR_OFFSET_COUNTS
    }
}

/// Model minus reading of a candidate over a horizon, counts, one entry a sample; see [`FitProblem::errors`](super::FitProblem::errors).
///
/// # Errors
/// Parameters from which no model can be made.
pub fn errors(
    data: &Data,
    candidate: &Candidate,
    method: Method,
    horizon: &Horizon,
    start_angle: StartAngle,
    cost: Cost,
) -> Result<Vec<f64>, ModelError> {
    let simulation = Simulation::new(data, candidate, method)?;
    let segments = segments(data, candidate, horizon, start_angle);
    let mut errors = simulation.errors(horizon.mode(), &segments);
    centre(data, candidate, horizon, start_angle, cost, &mut errors);
    Ok(errors)
}

/// Whether the errors are shifted by a free start angle.
pub(super) fn is_centred(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
) -> bool {
    // Where effects depend on the angle it is absolute, and a shift would be one freedom too many.
    let absolute = data.quantised && candidate.needs_angle();
    *horizon == Horizon::Whole && start_angle == StartAngle::Free && !absolute
}

/// Shifts the errors of each recording to its best start angle where it is free: the median for absolute costs, else the mean.
/// A recording after the first that may start in motion has its best start speed besides.
pub(super) fn centre(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
    cost: Cost,
    errors: &mut [f64],
) {
    if *horizon != Horizon::Whole || start_angle != StartAngle::Free {
        return;
    }
    let centre = data.half_cell();
    // Only the first recording's start angle can be an unknown of the model.
    let known = usize::from(!is_centred(data, candidate, horizon, start_angle));
    let ranges = data.recordings.ranges().skip(known);
    for range in ranges.filter(|range| !range.is_empty()) {
        let moving = range.start > 0 && data.may_start_moving(range.start);
        let times = &data.time_s[range.clone()];
        let errors = &mut errors[range];
        if moving {
            project_out_start_speed(times, candidate.machine.response().a1, errors);
        }
        let middle = match cost {
            Cost::Absolute { .. } => median(errors),
            Cost::Squared | Cost::Interval { .. } => mean(errors),
        };
        for error in errors {
            *error += centre - middle;
        }
    }
}

/// Takes out of the errors what another start speed would change: the speed decays with the motor's time constant a1, so that
/// the angle moves by `1 − exp(−t/a1)`. Only the first recording's start speed is an unknown; the others' are linear ones
/// that least squares give at once (variable projection: Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973).
fn project_out_start_speed(times: &[f64], time_constant: f64, errors: &mut [f64]) {
    let (Some(&from), Some(&to)) = (times.first(), times.last()) else {
        return;
    };
    let span = to - from;
    let decays = time_constant > 0.0 && time_constant < MANY_SPANS * span;
    let course = |time: &f64| {
        let time = time - from;
        if decays {
            -libm::expm1(-time / time_constant)
        } else {
            time / span
        }
    };
    let course: Vec<f64> = times.iter().map(course).collect();
    let (middle, error) = (mean(&course), mean(errors));
    let about = || course.iter().map(|at| at - middle);
    let squares: f64 = about().map(|at| at * at).sum();
    let products: f64 = (about().zip(&*errors))
        .map(|(at, e)| at * (e - error))
        .sum();
    let slope = products / squares;
    if slope.is_finite() {
        for (e, at) in errors.iter_mut().zip(&course) {
            *e -= slope * (at - middle);
        }
    }
}

/// A time constant so many times longer than the recording is none.
const MANY_SPANS: f64 = 1e3;

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Root mean square of model minus measurement, in counts, where the measurement is the centre of
/// the cell that was read.
pub fn rms_counts(data: &Data, errors: &[f64]) -> f64 {
    let centre = if data.quantised {
        shared::encoder::FLOOR_OFFSET_COUNTS
    } else {
        0.0
    };
    let sum: f64 = errors.iter().map(|e| (e - centre) * (e - centre)).sum();
    Cost::rms(sum, errors.len())
}
